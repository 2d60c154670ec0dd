//! The keyboard's library (libxkbcommon, loaded when a window opens) as baseview 0.4 asks for it, with its keymap given back.
//!
//! baseview makes a keymap and a state of it for every window, and when the window closes gives back the state only: 70 kB
//! stay for good. The state holds the keymap itself, so what is missing is a single call after the state is made, at a place
//! that nothing outside of baseview reaches but the table of functions it gets from the crate `xkbcommon-dl`. This crate takes
//! that one's place (`[patch.crates-io]` in the workspace), has of it what baseview uses, and makes the call.
//!
//! To be taken out as soon as baseview makes it itself: twice would be once too often. A test holds baseview to the version
//! that this was written for.

#![cfg(target_os = "linux")]
// The names are those of the library.
#![allow(non_camel_case_types)]

use std::ffi::{c_char, c_int};
use std::sync::OnceLock;

use libloading::Library;

/// What keymaps are made in.
#[repr(C)]
pub struct xkb_context {
    _opaque: [u8; 0],
}

/// What the keys mean.
#[repr(C)]
pub struct xkb_keymap {
    _opaque: [u8; 0],
}

/// Which keys of a keymap are down.
#[repr(C)]
pub struct xkb_state {
    _opaque: [u8; 0],
}

/// Number of a key.
pub type xkb_keycode_t = u32;

/// Which parts of a state have changed, as bits.
pub type xkb_state_component = u32;

/// How to make a context.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub enum xkb_context_flags {
    /// As it comes.
    XKB_CONTEXT_NO_FLAGS = 0,
}

/// How to make a keymap.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub enum xkb_keymap_compile_flags {
    /// As it comes.
    XKB_KEYMAP_COMPILE_NO_FLAGS = 0,
}

/// What became of a key.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub enum xkb_key_direction {
    /// It was let go.
    XKB_KEY_UP = 0,
    /// It was pressed.
    XKB_KEY_DOWN = 1,
}

/// Functions of libxkbcommon.
pub struct XkbCommon {
    /// Makes a context.
    pub xkb_context_new: unsafe extern "C" fn(xkb_context_flags) -> *mut xkb_context,
    /// Gives it back.
    pub xkb_context_unref: unsafe extern "C" fn(*mut xkb_context),
    /// Gives a keymap back.
    pub xkb_keymap_unref: unsafe extern "C" fn(*mut xkb_keymap),
    /// Gives a state back.
    pub xkb_state_unref: unsafe extern "C" fn(*mut xkb_state),
    /// Writes what a key types, with a zero at the end, into a buffer of so many bytes; returns its length.
    pub xkb_state_key_get_utf8:
        unsafe extern "C" fn(*mut xkb_state, xkb_keycode_t, *mut c_char, usize) -> c_int,
    /// Tells of a key.
    pub xkb_state_update_key:
        unsafe extern "C" fn(*mut xkb_state, xkb_keycode_t, xkb_key_direction) -> xkb_state_component,
    /// What the functions are in, kept open.
    _library: Library,
}

impl XkbCommon {
    fn open() -> Option<XkbCommon> {
        // SAFETY: opening the library runs no code but the loader's; the signatures are those of its headers (xkbcommon.h).
        unsafe {
            let library = open(["libxkbcommon.so.0", "libxkbcommon.so"])?;
            Some(XkbCommon {
                xkb_context_new: *library.get(b"xkb_context_new\0").ok()?,
                xkb_context_unref: *library.get(b"xkb_context_unref\0").ok()?,
                xkb_keymap_unref: *library.get(b"xkb_keymap_unref\0").ok()?,
                xkb_state_unref: *library.get(b"xkb_state_unref\0").ok()?,
                xkb_state_key_get_utf8: *library.get(b"xkb_state_key_get_utf8\0").ok()?,
                xkb_state_update_key: *library.get(b"xkb_state_update_key\0").ok()?,
                _library: library,
            })
        }
    }
}

/// The functions, if the library is there.
pub fn xkbcommon_option() -> Option<&'static XkbCommon> {
    static LOADED: OnceLock<Option<XkbCommon>> = OnceLock::new();
    LOADED.get_or_init(XkbCommon::open).as_ref()
}

/// The first of these libraries that there is.
unsafe fn open(names: [&str; 2]) -> Option<Library> {
    // SAFETY: up to the caller, who knows what is in them.
    names.into_iter().find_map(|name| unsafe { Library::new(name).ok() })
}

/// What libxkbcommon-x11 adds.
pub mod x11 {
    use std::sync::OnceLock;

    use libloading::Library;

    use super::{open, xkb_context, xkb_keymap, xkb_keymap_compile_flags, xkb_state, xkbcommon_option};

    /// A connection to the X server.
    pub type xcb_connection_t = std::ffi::c_void;

    /// Makes a state of a keymap and of what a device's keys are just now.
    type MakeState = unsafe extern "C" fn(*mut xkb_keymap, *mut xcb_connection_t, i32) -> *mut xkb_state;

    /// Functions of libxkbcommon-x11.
    pub struct XkbCommonX11 {
        /// Number of the keyboard, -1 if there is none.
        pub xkb_x11_get_core_keyboard_device_id: unsafe extern "C" fn(*mut xcb_connection_t) -> i32,
        /// Makes a keymap of what a device has.
        pub xkb_x11_keymap_new_from_device: unsafe extern "C" fn(
            *mut xkb_context,
            *mut xcb_connection_t,
            i32,
            xkb_keymap_compile_flags,
        ) -> *mut xkb_keymap,
        /// Makes a state, which from then on is all that holds the keymap.
        pub xkb_x11_state_new_from_device: MakeState,
        /// The library's own, which leaves the keymap to the caller, too.
        make_state: MakeState,
        /// What the functions are in, kept open.
        _library: Library,
    }

    impl XkbCommonX11 {
        fn open() -> Option<XkbCommonX11> {
            // SAFETY: opening the library runs no code but the loader's; the signatures are those of its headers
            // (xkbcommon-x11.h).
            unsafe {
                let library = open(["libxkbcommon-x11.so.0", "libxkbcommon-x11.so"])?;
                Some(XkbCommonX11 {
                    xkb_x11_get_core_keyboard_device_id: *library
                        .get(b"xkb_x11_get_core_keyboard_device_id\0")
                        .ok()?,
                    xkb_x11_keymap_new_from_device: *library.get(b"xkb_x11_keymap_new_from_device\0").ok()?,
                    xkb_x11_state_new_from_device: make_owning_state,
                    make_state: *library.get(b"xkb_x11_state_new_from_device\0").ok()?,
                    _library: library,
                })
            }
        }
    }

    /// The functions, if the library is there.
    pub fn xkbcommon_x11_option() -> Option<&'static XkbCommonX11> {
        static LOADED: OnceLock<Option<XkbCommonX11>> = OnceLock::new();
        LOADED.get_or_init(XkbCommonX11::open).as_ref()
    }

    /// Makes a state and gives the caller's share of the keymap back: see the [crate].
    unsafe extern "C" fn make_owning_state(
        keymap: *mut xkb_keymap,
        connection: *mut xcb_connection_t,
        device: i32,
    ) -> *mut xkb_state {
        // Whoever calls this has got it from there.
        let (Some(common), Some(x11)) = (xkbcommon_option(), xkbcommon_x11_option()) else {
            return std::ptr::null_mut();
        };
        // SAFETY: up to the caller, but for the keymap: the state has taken a share of its own, and baseview has no other use for
        // the one it holds.
        unsafe {
            let state = (x11.make_state)(keymap, connection, device);
            (common.xkb_keymap_unref)(keymap);
            state
        }
    }
}
