//! Units and the names of notes.
//!
//! The framework tells the groups of parameters but not the root they hang from; hosts that take the first unit for the
//! root would lose a group. And it names no notes: this format hangs their names on a program, so there is a list of
//! one, which nobody can change.

use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::{
    BusDirection, CString, IUnitInfoTrait, MediaType, ProgramListID, ProgramListInfo, String128, TChar,
    UnitID, UnitInfo, kNoParentUnitId, kRootUnitId,
};
use nice_plug::wrapper::vst3::vst3::Steinberg::{
    IBStream, int16, int32, kInvalidArgument, kResultOk, tresult,
};

use super::*;

/// Id of the list whose one program has the names of notes.
const LIST: ProgramListID = 1;

impl<P: Vst3Plugin> IUnitInfoTrait for Guard<P> {
    unsafe fn getUnitCount(&self) -> int32 {
        // SAFETY: passed on.
        1 + caught("IUnitInfoTrait::getUnitCount", 0, || unsafe { self.framework.getUnitCount() })
    }

    unsafe fn getUnitInfo(&self, index: int32, info: *mut UnitInfo) -> tresult {
        if index != 0 {
            // SAFETY: passed on, behind the root.
            return caught("IUnitInfoTrait::getUnitInfo", kInternalError, || unsafe {
                self.framework.getUnitInfo(index - 1, info)
            });
        }
        // SAFETY: `info` is null or valid.
        let Some(info) = (unsafe { info.as_mut() }) else { return kInvalidArgument };
        info.id = kRootUnitId;
        info.parentUnitId = kNoParentUnitId;
        info.programListId = LIST;
        write(P::NAME, &mut info.name);
        kResultOk
    }

    unsafe fn getProgramListCount(&self) -> int32 {
        1
    }

    unsafe fn getProgramListInfo(&self, index: int32, info: *mut ProgramListInfo) -> tresult {
        // SAFETY: `info` is null or valid.
        let (0, Some(info)) = (index, unsafe { info.as_mut() }) else { return kInvalidArgument };
        info.id = LIST;
        info.programCount = 1;
        write("Notes", &mut info.name);
        kResultOk
    }

    unsafe fn getProgramName(&self, list: ProgramListID, index: int32, name: *mut String128) -> tresult {
        // SAFETY: `name` is null or valid.
        let (LIST, 0, Some(name)) = (list, index, unsafe { name.as_mut() }) else { return kInvalidArgument };
        write(P::NAME, name);
        kResultOk
    }

    pass_on!(@ IUnitInfoTrait getProgramInfo(
        list: ProgramListID, index: int32, id: CString, value: *mut String128
    ) -> tresult);

    unsafe fn hasProgramPitchNames(&self, list: ProgramListID, index: int32) -> tresult {
        if (list, index) == (LIST, 0) { kResultOk } else { kInvalidArgument }
    }

    unsafe fn getProgramPitchName(
        &self,
        list: ProgramListID,
        index: int32,
        pitch: int16,
        name: *mut String128,
    ) -> tresult {
        // SAFETY: `name` is null or valid.
        let (LIST, 0, Some(name)) = (list, index, unsafe { name.as_mut() }) else { return kInvalidArgument };
        let named =
            || self.parameters.as_ref()?.note_names().into_iter().find(|(note, _)| i16::from(*note) == pitch);
        let Some((_, title)) = caught("IUnitInfoTrait::getProgramPitchName", None, named) else {
            return kInvalidArgument;
        };
        write(&title, name);
        kResultOk
    }

    pass_on!(@ IUnitInfoTrait getSelectedUnit() -> UnitID);
    pass_on!(@ IUnitInfoTrait selectUnit(id: UnitID) -> tresult);
    pass_on!(@ IUnitInfoTrait getUnitByBus(
        media: MediaType, direction: BusDirection, bus: int32, channel: int32, id: *mut UnitID
    ) -> tresult);
    pass_on!(@ IUnitInfoTrait setUnitProgramData(list: int32, index: int32, data: *mut IBStream) -> tresult);
}

/// Writes as much of a text as there is room for, and a zero.
pub(super) fn write(text: &str, into: &mut String128) {
    into.fill(0);
    let room = into.len() - 1;
    for (to, from) in into[..room].iter_mut().zip(text.encode_utf16()) {
        *to = from as TChar;
    }
}
