//! What hosts look for in the library: the factory of both instruments, and the module's entries.

use super::*;

/// Makes both instruments.
pub(super) struct Factory {
    pub(super) plugins: [PluginInfo; 2],
}

impl Class for Factory {
    type Interfaces = (IPluginFactory, IPluginFactory2, IPluginFactory3);
}

impl Factory {
    pub(super) fn new() -> Factory {
        Factory { plugins: [PluginInfo::for_plugin::<Overhear>(), PluginInfo::for_plugin::<OverhearMulti>()] }
    }

    /// Writes what is known of the plugin of an index.
    ///
    /// # Safety
    /// `into` is null or valid.
    unsafe fn describe<T>(&self, index: int32, into: *mut T, describe: fn(&PluginInfo) -> T) -> tresult {
        caught("IPluginFactory", kInternalError, || {
            let plugin = usize::try_from(index).ok().and_then(|index| self.plugins.get(index));
            // SAFETY: as promised.
            match (plugin, unsafe { into.as_mut() }) {
                (Some(plugin), Some(into)) => {
                    *into = describe(plugin);
                    kResultOk
                }
                _ => kInvalidArgument,
            }
        })
    }
}

impl IPluginFactoryTrait for Factory {
    unsafe fn getFactoryInfo(&self, info: *mut PFactoryInfo) -> tresult {
        // SAFETY: `info` is null or valid.
        unsafe { self.describe(0, info, PluginInfo::create_factory_info) }
    }

    unsafe fn countClasses(&self) -> int32 {
        self.plugins.len() as int32
    }

    unsafe fn getClassInfo(&self, index: int32, info: *mut PClassInfo) -> tresult {
        // SAFETY: `info` is null or valid.
        unsafe { self.describe(index, info, PluginInfo::create_class_info) }
    }

    unsafe fn createInstance(
        &self,
        class: FIDString,
        interface: FIDString,
        into: *mut *mut c_void,
    ) -> tresult {
        if class.is_null() || interface.is_null() || into.is_null() {
            return kInvalidArgument;
        }
        // SAFETY: both ids are 16 bytes, and `into` is valid, by the format's contract.
        caught("IPluginFactory::createInstance", kInternalError, || unsafe {
            match &*class.cast::<[u8; 16]>() {
                class if class == self.plugins[0].cid => made(Guard::<Overhear>::new(), interface, into),
                class if class == self.plugins[1].cid => made(Guard::<OverhearMulti>::new(), interface, into),
                _ => kInvalidArgument,
            }
        })
    }
}

/// Hands an object out as the interface asked for.
///
/// # Safety
/// `interface` is 16 bytes, `into` valid.
unsafe fn made<P: Vst3Plugin>(guard: Guard<P>, interface: FIDString, into: *mut *mut c_void) -> tresult {
    let object = ComWrapper::new(guard);
    let Some(unknown) = object.as_com_ref::<FUnknown>() else { return kInvalidArgument };
    let unknown = unknown.as_ptr();
    // SAFETY: `unknown` lives as long as `object`; asking it for an interface takes a reference of the host's.
    unsafe { ((*(*unknown).vtbl).queryInterface)(unknown, interface.cast(), into) }
}

impl IPluginFactory2Trait for Factory {
    unsafe fn getClassInfo2(&self, index: int32, info: *mut PClassInfo2) -> tresult {
        // SAFETY: `info` is null or valid.
        unsafe { self.describe(index, info, PluginInfo::create_class_info_2) }
    }
}

impl IPluginFactory3Trait for Factory {
    unsafe fn getClassInfoUnicode(&self, index: int32, info: *mut PClassInfoW) -> tresult {
        // SAFETY: `info` is null or valid.
        unsafe { self.describe(index, info, PluginInfo::create_class_info_unicode) }
    }

    unsafe fn setHostContext(&self, _context: *mut FUnknown) -> tresult {
        kResultOk
    }
}

#[unsafe(no_mangle)]
pub(super) extern "system" fn GetPluginFactory() -> *mut c_void {
    caught("GetPluginFactory", std::ptr::null_mut(), || {
        let factory = ComWrapper::new(Factory::new()).to_com_ptr::<IPluginFactory>();
        factory.map_or(std::ptr::null_mut(), |factory| factory.into_raw().cast())
    })
}

/// What every system's entry does.
pub(super) fn loaded() -> bool {
    caught("module entry", false, || {
        setup_logger::<Overhear>();
        true
    })
}

#[cfg(all(target_family = "unix", not(target_os = "macos")))]
#[unsafe(no_mangle)]
extern "C" fn ModuleEntry(_library: *mut c_void) -> bool {
    loaded()
}

#[cfg(all(target_family = "unix", not(target_os = "macos")))]
#[unsafe(no_mangle)]
extern "C" fn ModuleExit() -> bool {
    true
}

#[cfg(target_os = "macos")]
#[unsafe(no_mangle)]
extern "C" fn bundleEntry(_bundle: *mut c_void) -> bool {
    loaded()
}

#[cfg(target_os = "macos")]
#[unsafe(no_mangle)]
extern "C" fn bundleExit() -> bool {
    true
}

#[cfg(target_os = "windows")]
#[unsafe(no_mangle)]
extern "system" fn InitDll() -> bool {
    loaded()
}

#[cfg(target_os = "windows")]
#[unsafe(no_mangle)]
extern "system" fn ExitDll() -> bool {
    true
}
