//! Parameters: those of the table with their steps, and behind them the MIDI controllers.

use std::ptr;

use nice_plug::wrapper::vst3::vst3::ComPtr;
use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::ParameterInfo_::ParameterFlags_;
use overhear_player::parameters::stepped;

use super::view::View;
use super::*;

impl<P: Vst3Plugin> Guard<P> {
    /// How many parameters there are without controllers: the table and the bypass.
    fn proper(&self) -> usize {
        self.parameters.as_ref().map_or(0, |parameters| parameters.values().len() + 1)
    }
}

impl<P: Vst3Plugin> IEditControllerTrait for Guard<P> {
    pass_on!(@ IEditControllerTrait setComponentState(state: *mut IBStream) -> tresult);
    pass_on!(@ IEditControllerTrait setState(state: *mut IBStream) -> tresult);
    pass_on!(@ IEditControllerTrait getState(state: *mut IBStream) -> tresult);
    pass_on!(@ IEditControllerTrait normalizedParamToPlain(id: ParamID, value: ParamValue) -> ParamValue);
    pass_on!(@ IEditControllerTrait plainParamToNormalized(id: ParamID, value: ParamValue) -> ParamValue);
    pass_on!(@ IEditControllerTrait setComponentHandler(handler: *mut IComponentHandler) -> tresult);
    pass_on!(@ IEditControllerTrait getParamValueByString(
        id: ParamID, text: *mut TChar, value: *mut ParamValue
    ) -> tresult);

    unsafe fn createView(&self, name: FIDString) -> ViewPointer {
        // SAFETY: passed on; what the framework makes comes with a count of its own.
        caught("IEditControllerTrait::createView", ptr::null_mut(), || unsafe {
            let view = ComPtr::from_raw(self.framework.createView(name));
            view.map_or(ptr::null_mut(), |view| View::around(view, self.parameters.clone()))
        })
    }

    unsafe fn getParameterCount(&self) -> int32 {
        (self.proper() + controllers::COUNT) as int32
    }

    unsafe fn getParameterInfo(&self, index: int32, info: *mut ParameterInfo) -> tresult {
        let (proper, Ok(index)) = (self.proper(), usize::try_from(index)) else { return kInvalidArgument };
        let place = match index.checked_sub(proper) {
            None => Some(index),
            Some(offered) => controllers::of_framework(offered).map(|place| proper + place),
        };
        let Some(place) = place else { return kInvalidArgument };
        // SAFETY: passed on; `info` is null or valid.
        caught("IEditControllerTrait::getParameterInfo", kInternalError, || unsafe {
            let result = self.framework.getParameterInfo(place as int32, info);
            if let Some(info) = info.as_mut().filter(|_| result == kResultOk)
                && let Some(steps) = stepped(info.id)
            {
                info.stepCount = steps as int32;
                info.flags |= ParameterFlags_::kIsList as int32;
            }
            result
        })
    }

    unsafe fn getParamStringByValue(&self, id: ParamID, value: ParamValue, text: *mut String128) -> tresult {
        if self.controllers.get(id).is_some() {
            // SAFETY: `text` is null or valid.
            let Some(text) = (unsafe { text.as_mut() }) else { return kInvalidArgument };
            units::write(&format!("{:.0}", 127.0 * value), text);
            return kResultOk;
        }
        // SAFETY: passed on.
        caught("IEditControllerTrait::getParamStringByValue", kInternalError, || unsafe {
            self.framework.getParamStringByValue(id, value, text)
        })
    }

    unsafe fn getParamNormalized(&self, id: ParamID) -> ParamValue {
        if let Some(value) = self.controllers.get(id).or_else(|| self.edits.get(id)) {
            return value;
        }
        // SAFETY: passed on.
        caught("IEditControllerTrait::getParamNormalized", 0.0, || unsafe {
            self.framework.getParamNormalized(id)
        })
    }

    unsafe fn setParamNormalized(&self, id: ParamID, value: ParamValue) -> tresult {
        if self.controllers.set(id, value) {
            return kResultOk;
        }
        if self.processes.load(Ordering::Acquire) {
            self.edits.set(id, value);
        } else {
            self.edits.arrived(id);
        }
        // SAFETY: passed on.
        caught("IEditControllerTrait::setParamNormalized", kInternalError, || unsafe {
            self.framework.setParamNormalized(id, value)
        })
    }
}
