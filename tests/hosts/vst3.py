"""Renders one job through a VST3 bundle with DawDreamer.

The argument is a JSON file: plugin, rate, block, frames, notes [[sample, key, velocity]],
parameters [[index, share of the range]], automation [[index, [share of the range for each block]]],
preset (a .vstpreset to load first, or null), load and save (files of this host's states, or null),
out. Left and then right samples are written to `out` as little-endian 32-bit floats.
"""

import json
import sys

import dawdreamer
import numpy

with open(sys.argv[1]) as file:
    job = json.load(file)

engine = dawdreamer.RenderEngine(job["rate"], job["block"])
plugin = engine.make_plugin_processor("overhear", job["plugin"])
if job["preset"] and not plugin.load_vst3_preset(job["preset"]):
    sys.exit("the preset is refused")
if job["load"]:
    plugin.load_state(job["load"])
for index, value in job["parameters"]:
    if not plugin.set_parameter(index, value):
        sys.exit(f"parameter {index} is refused")
for index, values in job["automation"]:
    # Looked up at each block's start, give or take a sample: let the value hold on both sides of it.
    values = numpy.roll(numpy.repeat(numpy.float32(values), job["block"]), -job["block"] // 2)
    if not plugin.set_automation(index, values):
        sys.exit(f"automation of parameter {index} is refused")
for sample, key, velocity in job["notes"]:
    # DawDreamer takes seconds and cuts them to a sample: aim behind its start, not at it.
    start = (sample + 0.25) / job["rate"]
    if not plugin.add_midi_note(key, velocity, start, 0.05):
        sys.exit(f"the note at sample {sample} is refused")
engine.load_graph([(plugin, [])])
engine.render((job["frames"] + job["block"]) / job["rate"])
sound = engine.get_audio()[:2, : job["frames"]]
if sound.shape != (2, job["frames"]):
    sys.exit(f"the host gave samples of the shape {sound.shape}")
sound.astype("<f4").tofile(job["out"])
if job["save"]:
    plugin.save_state(job["save"])
