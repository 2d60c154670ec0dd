-- Makes a session with a track of each instrument: OVERHEAR_SESSION is its folder, named like the session.

local folder = os.getenv("OVERHEAR_SESSION")
AudioEngine:set_backend("None (Dummy)", "Overhear", "")
assert(create_session(folder, "session", 48000), "no session")

local midi = ARDOUR.ChanCount(ARDOUR.DataType("midi"), 1)
for _, track in ipairs({ { "Overhear", 2 }, { "Overhear Multi", 38 } }) do
  local name, channels = table.unpack(track)
  local plugin = ARDOUR.LuaAPI.new_plugin_info(name, ARDOUR.PluginType.VST3)
  assert(not plugin:isnil(), "Ardour does not know " .. name)
  local audio = ARDOUR.ChanCount(ARDOUR.DataType("audio"), channels)
  local last = ARDOUR.PresentationInfo.max_order
  Session:new_midi_track(midi, audio, true, plugin, nil, nil, 1, name, last, ARDOUR.TrackMode.Normal, true)
end

-- Another thread connects the tracks to the master bus.
sleep(2)
Session:save_state("")
close_session()
quit()
