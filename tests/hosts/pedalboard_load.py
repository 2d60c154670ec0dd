"""Loads a plugin of a VST3 bundle in pedalboard and plays a note; says how long that took.

Arguments: the bundle, the plugin's name. Prints, as JSON, seconds from the start of loading: `loaded` and `heard` by the clock, and
`work`, the processor time of loading on all threads; `peak` is that of the sound, `parameters` how many the host found.
"""

import json
import sys
import time

import pedalboard

bundle, name = sys.argv[1:]
begun, work = time.monotonic(), time.process_time()
plugin = pedalboard.VST3Plugin(bundle, plugin_name=name)
loaded, work = time.monotonic() - begun, time.process_time() - work
sound = plugin([([0x99, 38, 100], 0.0)], duration=0.1, sample_rate=48_000, num_channels=2, buffer_size=512)
heard = time.monotonic() - begun
peak = float(abs(sound).max())
found = {"loaded": loaded, "heard": heard, "work": work, "peak": peak, "parameters": len(plugin.parameters)}
print(json.dumps(found))
