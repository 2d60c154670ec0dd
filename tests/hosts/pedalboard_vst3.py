"""Renders one job through a VST3 bundle with pedalboard, which leaves all outputs but the main one inactive.

The argument is a JSON file: plugin, name, preset (a .vstpreset to load first, or null), rate, block, frames,
notes [[sample, key, velocity]], messages [[sample, [byte]]] (optional), out. Left and then right samples are written to `out` as little-endian 32-bit floats.
"""

import json
import sys

import pedalboard

with open(sys.argv[1]) as file:
    job = json.load(file)

plugin = pedalboard.VST3Plugin(job["plugin"], plugin_name=job["name"])
if job["preset"]:
    plugin.load_preset(job["preset"])
    # It goes on with the parameter values from before the preset, and sets them when it plays. From a state it reads them anew.
    plugin.raw_state = plugin.raw_state
# Pedalboard takes seconds and cuts them to a sample: aim behind its start, not at it.
notes = [([0x99, key, velocity], (sample + 0.25) / job["rate"]) for sample, key, velocity in job["notes"]]
notes += [(bytes_, (sample + 0.25) / job["rate"]) for sample, bytes_ in job.get("messages", [])]
sound = plugin(
    notes,
    duration=(job["frames"] + job["block"]) / job["rate"],
    sample_rate=job["rate"],
    num_channels=2,
    buffer_size=job["block"],
)
sound = sound[:, : job["frames"]]
if sound.shape != (2, job["frames"]):
    sys.exit(f"the host gave samples of the shape {sound.shape}")
sound.astype("<f4").tofile(job["out"])
