//! A window as VST3 hosts hold it.
//!
//! The framework's refuses a scale that comes before it is attached, which is when hosts tell it. This one keeps it for the
//! window to come, and passes everything else on. Hosts compare the window that asks for a size with the one they hold, so that
//! the framework gets a frame of this module's, which asks in this window's name.

use std::ptr;
use std::sync::atomic::{AtomicBool, AtomicPtr, Ordering};

use nice_plug::wrapper::vst3::vst3::Steinberg::IPlugViewContentScaleSupport_::ScaleFactor;
use nice_plug::wrapper::vst3::vst3::Steinberg::Linux::{
    FileDescriptor, IEventHandler, IRunLoop, IRunLoopTrait, ITimerHandler, TimerInterval,
};
use nice_plug::wrapper::vst3::vst3::Steinberg::{
    IPlugFrame, IPlugFrameTrait, IPlugViewContentScaleSupport, IPlugViewContentScaleSupportTrait,
    IPlugViewTrait, ViewRect, char16,
};
use nice_plug::wrapper::vst3::vst3::{ComPtr, ComRef};

use super::*;
use crate::scale;

/// The framework's window, and what the host has said of its scale.
pub(super) struct View {
    framework: ComPtr<IPlugView>,
    parameters: Option<Arc<HostParameters>>,
    attached: AtomicBool,
    /// As hosts have it. Not counted, as nobody keeps it longer than the window.
    own: AtomicPtr<IPlugView>,
}

impl Class for View {
    type Interfaces = (IPlugView, IPlugViewContentScaleSupport);
}

impl View {
    /// One around a window of the framework's, for the host to release.
    pub(super) fn around(
        framework: ComPtr<IPlugView>,
        parameters: Option<Arc<HostParameters>>,
    ) -> *mut IPlugView {
        if let Some(parameters) = &parameters {
            // What was said of another window.
            parameters.scale().tell(None);
        }
        let (attached, own) = (AtomicBool::new(false), AtomicPtr::default());
        let view = ComWrapper::new(View { framework, parameters, attached, own });
        let Some(handed_out) = view.to_com_ptr::<IPlugView>() else { return ptr::null_mut() };
        view.own.store(handed_out.as_ptr(), Ordering::Release);
        handed_out.into_raw()
    }
}

impl Drop for View {
    fn drop(&mut self) {
        // SAFETY: calls a host makes. One that leaves its window open may have forgotten its frame as well.
        unsafe {
            if self.attached.load(Ordering::Acquire) {
                self.framework.removed();
            }
            self.framework.setFrame(ptr::null_mut());
        }
    }
}

/// Passes a call on. Whoever calls has promised the format's contract, which is all that the framework asks.
macro_rules! pass_on {
    ($($method:ident($($argument:ident: $type:ty),*);)*) => {
        $(unsafe fn $method(&self, $($argument: $type),*) -> tresult {
            // SAFETY: see above.
            unsafe { self.framework.$method($($argument),*) }
        })*
    };
}

impl IPlugViewTrait for View {
    pass_on! {
        isPlatformTypeSupported(platform: FIDString);
        onWheel(distance: f32);
        onKeyDown(key: char16, code: int16, modifiers: int16);
        onKeyUp(key: char16, code: int16, modifiers: int16);
        getSize(size: *mut ViewRect);
        onSize(size: *mut ViewRect);
        onFocus(state: TBool);
        canResize();
        checkSizeConstraint(size: *mut ViewRect);
    }

    unsafe fn attached(&self, parent: *mut c_void, platform: FIDString) -> tresult {
        // SAFETY: passed on.
        let result = unsafe { self.framework.attached(parent, platform) };
        if result == kResultOk {
            self.attached.store(true, Ordering::Release);
        }
        result
    }

    unsafe fn removed(&self) -> tresult {
        self.attached.store(false, Ordering::Release);
        // SAFETY: passed on.
        unsafe { self.framework.removed() }
    }

    unsafe fn setFrame(&self, frame: *mut IPlugFrame) -> tresult {
        let own = self.own.load(Ordering::Acquire);
        // SAFETY: a frame is null or valid; the framework counts what it keeps.
        unsafe {
            let Some(host) = ComRef::from_raw(frame).map(|frame| frame.to_com_ptr()) else {
                return self.framework.setFrame(ptr::null_mut());
            };
            let run_loop = host.cast::<IRunLoop>();
            let frame = Frame { host, own };
            let frame = match run_loop {
                Some(run_loop) => {
                    ComWrapper::new(FrameWithLoop { frame, run_loop }).to_com_ptr::<IPlugFrame>()
                }
                None => ComWrapper::new(frame).to_com_ptr::<IPlugFrame>(),
            };
            frame.map_or(kInternalError, |frame| self.framework.setFrame(frame.as_ptr()))
        }
    }
}

impl IPlugViewContentScaleSupportTrait for View {
    unsafe fn setContentScaleFactor(&self, factor: ScaleFactor) -> tresult {
        let factor_wide = f64::from(factor);
        let Some(parameters) = self.parameters.as_ref().filter(|_| scale::is_sane(factor_wide)) else {
            return kInvalidArgument;
        };
        if self.attached.load(Ordering::Acquire) {
            let Some(framework) = self.framework.cast::<IPlugViewContentScaleSupport>() else {
                return kResultFalse;
            };
            // SAFETY: passed on.
            let result = unsafe { framework.setContentScaleFactor(factor) };
            if result != kResultOk {
                return result;
            }
        }
        parameters.scale().tell(Some(factor_wide));
        kResultOk
    }
}

/// The host's frame, asked in the name of the window that the host holds.
struct Frame {
    host: ComPtr<IPlugFrame>,
    own: *mut IPlugView,
}

impl Class for Frame {
    type Interfaces = (IPlugFrame,);
}

impl IPlugFrameTrait for Frame {
    unsafe fn resizeView(&self, _framework: *mut IPlugView, size: *mut ViewRect) -> tresult {
        // SAFETY: passed on; the framework has no frame any more once the window is gone.
        unsafe { self.host.resizeView(self.own, size) }
    }
}

/// One of a host that has a loop of events to hang on to.
struct FrameWithLoop {
    frame: Frame,
    run_loop: ComPtr<IRunLoop>,
}

impl Class for FrameWithLoop {
    type Interfaces = (IPlugFrame, IRunLoop);
}

impl IPlugFrameTrait for FrameWithLoop {
    unsafe fn resizeView(&self, framework: *mut IPlugView, size: *mut ViewRect) -> tresult {
        // SAFETY: passed on.
        unsafe { self.frame.resizeView(framework, size) }
    }
}

impl IRunLoopTrait for FrameWithLoop {
    unsafe fn registerEventHandler(&self, handler: *mut IEventHandler, fd: FileDescriptor) -> tresult {
        // SAFETY: passed on.
        unsafe { self.run_loop.registerEventHandler(handler, fd) }
    }

    unsafe fn unregisterEventHandler(&self, handler: *mut IEventHandler) -> tresult {
        // SAFETY: passed on.
        unsafe { self.run_loop.unregisterEventHandler(handler) }
    }

    unsafe fn registerTimer(&self, handler: *mut ITimerHandler, interval: TimerInterval) -> tresult {
        // SAFETY: passed on.
        unsafe { self.run_loop.registerTimer(handler, interval) }
    }

    unsafe fn unregisterTimer(&self, handler: *mut ITimerHandler) -> tresult {
        // SAFETY: passed on.
        unsafe { self.run_loop.unregisterTimer(handler) }
    }
}
