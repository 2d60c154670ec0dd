-- Opens the session in OVERHEAR_SESSION and does what OVERHEAR_STEPS lists, in its order:
--   edit       moves a parameter of each instrument and automates another
--   ignore     stops automation from being read
--   mute=NAME  mutes a track
--   play       plays for two seconds
--   export=X   exports the session to X.wav in its folder `export`
--   save       saves the session

local function tracks()
  local found = {}
  for route in Session:get_routes():iter() do
    local processor = route:nth_plugin(0)
    if not processor:isnil() then
      found[route:name()] = { route = route, processor = processor }
    end
  end
  assert(found["Overhear"] and found["Overhear Multi"], "a track has lost its instrument")
  return found
end

-- The number of a parameter among those of a plugin.
local function parameter(processor, label)
  local plugin = processor:to_insert():plugin(0)
  for index = 0, plugin:parameter_count() - 1 do
    if plugin:parameter_label(index) == label then
      return index
    end
  end
  error("no parameter " .. label)
end

local function set_automation(processor, state)
  local which = Evoral.Parameter(ARDOUR.AutomationType.PluginAutomation, 0, parameter(processor, "Snare Muffle"))
  processor:to_automatable():automation_control(which, false):set_automation_state(state)
end

local steps = {}

function steps.edit()
  for _, track in pairs(tracks()) do
    ARDOUR.LuaAPI.set_processor_param(track.processor, parameter(track.processor, "Kick Level"), 0.6)
    local list = ARDOUR.LuaAPI.plugin_automation(track.processor, parameter(track.processor, "Snare Muffle"))
    for at = 0, 6 do
      list:add(Temporal.timepos_t(at * 24000), (at % 2) * 0.8, false, true)
    end
    set_automation(track.processor, ARDOUR.AutoState.Play)
  end
  -- What was moved has to get there.
  sleep(1)
end

function steps.ignore()
  for _, track in pairs(tracks()) do
    set_automation(track.processor, ARDOUR.AutoState.Off)
  end
end

function steps.mute(name)
  tracks()[name].route:mute_control():set_value(1, PBD.GroupControlDisposition.NoGroup)
end

function steps.play()
  Session:goto_start()
  Session:request_roll(ARDOUR.TransportRequestSource.TRS_UI)
  sleep(2)
  assert(Session:transport_sample() > 0, "it does not play")
  Session:request_stop(false, false, ARDOUR.TransportRequestSource.TRS_UI)
  sleep(1)
end

function steps.export(name)
  local export = Session:simple_export()
  assert(export:set_preset(os.getenv("OVERHEAR_PRESET")), "no such preset")
  export:set_name(name)
  assert(export:run_export(), "no export")
end

function steps.save()
  Session:save_state("")
end

AudioEngine:set_backend("None (Dummy)", "Overhear", "")
assert(load_session(os.getenv("OVERHEAR_SESSION"), "session"), "no session")
-- Until the engine runs and every track has read its region.
sleep(1)
for step in os.getenv("OVERHEAR_STEPS"):gmatch("%S+") do
  local name, argument = step:match("^(%a+)=?(.*)$")
  steps[name](argument:gsub("_", " "))
  print("done: " .. step)
end
close_session()
quit()
