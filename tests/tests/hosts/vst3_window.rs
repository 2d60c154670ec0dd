//! The editor in a VST3 host of the tests' own, which calls the bundle's interfaces as they are.

use std::cell::RefCell;
use std::ffi::{c_char, c_void};
use std::ptr;
use std::thread;
use std::time::{Duration, Instant};

use ::vst3::Steinberg::Linux::{
    FileDescriptor, IEventHandler, IEventHandlerTrait, IRunLoop, IRunLoopTrait, ITimerHandler, TimerInterval,
};
use ::vst3::Steinberg::Vst::{IComponent, IEditController, IEditControllerTrait};
use ::vst3::Steinberg::{
    IPlugFrame, IPlugFrameTrait, IPlugView, IPlugViewContentScaleSupport, IPlugViewContentScaleSupportTrait,
    IPlugViewTrait, IPluginBaseTrait, IPluginFactory, IPluginFactoryTrait, PClassInfo, ViewRect,
    kNotImplemented, kResultOk, tresult,
};
use ::vst3::{Class, ComPtr, ComRef, ComWrapper, Interface};
use libloading::Library;
use overhear_cli::plugin_folders::Format;
use x11rb::protocol::xproto::{ConfigureWindowAux, ConnectionExt};

use crate::hand::own_size;
use crate::window::{PATIENCE, Parent};
use crate::{alone, bundle_path};

/// A fresh instance's window, points.
const POINTS: (u32, u32) = (980, 640);

/// A component with its library, which outlives it.
struct Hosted {
    component: ComPtr<IComponent>,
    _factory: ComPtr<IPluginFactory>,
    _library: Library,
}

impl Hosted {
    /// The first class of the bundle, initialized.
    fn new() -> Hosted {
        let path =
            bundle_path(Format::Vst3).join(format!("Contents/{}-linux/Overhear.so", std::env::consts::ARCH));
        // SAFETY: the bundle that was built, and the calls that a host makes, in their order.
        unsafe {
            let library = Library::new(path).expect("the bundle's library");
            let enter = library.get::<extern "C" fn(*mut c_void) -> bool>(b"ModuleEntry\0").unwrap();
            assert!(enter(ptr::null_mut()));
            let get =
                library.get::<extern "system" fn() -> *mut IPluginFactory>(b"GetPluginFactory\0").unwrap();
            let factory = ComPtr::from_raw(get()).expect("a factory");
            let mut class: PClassInfo = std::mem::zeroed();
            assert_eq!(factory.getClassInfo(0, &mut class), kResultOk);
            let (mut made, interface) = (ptr::null_mut(), IComponent::IID.as_ptr().cast::<c_char>());
            assert_eq!(factory.createInstance(class.cid.as_ptr(), interface, &mut made), kResultOk);
            let component = ComPtr::from_raw(made.cast::<IComponent>()).expect("a component");
            assert_eq!(component.initialize(ptr::null_mut()), kResultOk);
            Hosted { component, _factory: factory, _library: library }
        }
    }

    fn view(&self) -> ComPtr<IPlugView> {
        let controller = self.component.cast::<IEditController>().expect("a controller");
        // SAFETY: a call that a host makes.
        unsafe { ComPtr::from_raw(controller.createView(c"editor".as_ptr())) }.expect("a window")
    }
}

impl Drop for Hosted {
    fn drop(&mut self) {
        // SAFETY: the last call that a host makes.
        unsafe { self.component.terminate() };
    }
}

fn rectangle((width, height): (u32, u32)) -> ViewRect {
    ViewRect { left: 0, top: 0, right: width as i32, bottom: height as i32 }
}

fn size_of(view: &ComPtr<IPlugView>) -> (u32, u32) {
    let mut size = rectangle((0, 0));
    // SAFETY: there is room for a size.
    assert_eq!(unsafe { view.getSize(&mut size) }, kResultOk);
    ((size.right - size.left) as u32, (size.bottom - size.top) as u32)
}

fn tell(view: &ComPtr<IPlugView>, scale: f32) -> tresult {
    let support = view.cast::<IPlugViewContentScaleSupport>().expect("a window that knows of scales");
    // SAFETY: a call that a host makes.
    unsafe { support.setContentScaleFactor(scale) }
}

/// Puts a window into one of the host's.
fn attach(view: &ComPtr<IPlugView>, parent: &Parent) {
    let handle = parent.window as usize as *mut c_void;
    // SAFETY: the host's window exists.
    assert_eq!(unsafe { view.attached(handle, c"X11EmbedWindowID".as_ptr()) }, kResultOk);
}

fn remove(view: &ComPtr<IPlugView>) {
    // SAFETY: calls that a host makes.
    unsafe {
        assert_eq!(view.removed(), kResultOk);
        assert_eq!(view.setFrame(ptr::null_mut()), kResultOk);
    }
}

fn pixels(scale: f32) -> (u32, u32) {
    let of = |points: u32| (points as f32 * scale).round() as u32;
    (of(POINTS.0), of(POINTS.1))
}

fn wait_for(parent: &Parent, size: (u32, u32), what: &str) {
    let begun = Instant::now();
    while own_size(parent) != size {
        assert!(begun.elapsed() < PATIENCE, "{what}: {:?}, not {size:?}", own_size(parent));
        thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_vst3_window_takes_its_scale_before_it_is_attached_and_after() {
    let _turn = alone();
    let hosted = Hosted::new();
    for (round, scale) in [2.0, 2.0, 1.0, 1.5].into_iter().enumerate() {
        let what = format!("window {round}, scale {scale}");
        let view = hosted.view();
        assert_eq!(size_of(&view), POINTS, "{what}: before it is told");
        assert_eq!(tell(&view, scale), kResultOk, "{what}");
        assert_eq!(size_of(&view), pixels(scale), "{what}");
        let parent = Parent::new(pixels(scale).0, pixels(scale).1);
        attach(&view, &parent);
        wait_for(&parent, pixels(scale), &what);
        for nonsense in [0.0, -1.0, 1e6, f32::NAN] {
            assert_ne!(tell(&view, nonsense), kResultOk, "{what}: then {nonsense}");
        }
        assert_eq!(tell(&view, 1.25), kResultOk, "{what}");
        wait_for(&parent, pixels(1.25), &format!("{what}, then 1.25"));
        assert_eq!(size_of(&view), pixels(1.25), "{what}, then 1.25");
        remove(&view);
        assert_eq!(parent.children(), 0, "{what}");
    }
}

#[test]
fn a_vst3_window_that_is_let_go_while_it_is_attached_is_gone() {
    let _turn = alone();
    let hosted = Hosted::new();
    let parent = Parent::new(POINTS.0, POINTS.1);
    let view = hosted.view();
    attach(&view, &parent);
    assert_eq!(parent.children(), 1);
    drop(view);
    assert_eq!(parent.children(), 0);
}

/// A host's frame with its loop of events.
#[derive(Default)]
struct Frame {
    /// The windows that asked for a size, and which.
    asked: RefCell<Vec<(usize, (u32, u32))>>,
    handlers: RefCell<Vec<(ComPtr<IEventHandler>, FileDescriptor)>>,
}

impl Class for Frame {
    type Interfaces = (IPlugFrame, IRunLoop);
}

impl IPlugFrameTrait for Frame {
    unsafe fn resizeView(&self, view: *mut IPlugView, size: *mut ViewRect) -> tresult {
        // SAFETY: whoever asks gives a size.
        let size = unsafe { &*size };
        let wanted = ((size.right - size.left) as u32, (size.bottom - size.top) as u32);
        self.asked.borrow_mut().push((view.addr(), wanted));
        kResultOk
    }
}

impl IRunLoopTrait for Frame {
    unsafe fn registerEventHandler(&self, handler: *mut IEventHandler, fd: FileDescriptor) -> tresult {
        // SAFETY: whoever asks gives a handler.
        let handler = unsafe { ComRef::from_raw(handler) }.expect("a handler");
        self.handlers.borrow_mut().push((handler.to_com_ptr(), fd));
        kResultOk
    }

    unsafe fn unregisterEventHandler(&self, handler: *mut IEventHandler) -> tresult {
        self.handlers.borrow_mut().retain(|(known, _)| known.as_ptr() != handler);
        kResultOk
    }

    unsafe fn registerTimer(&self, _handler: *mut ITimerHandler, _interval: TimerInterval) -> tresult {
        kNotImplemented
    }

    unsafe fn unregisterTimer(&self, _handler: *mut ITimerHandler) -> tresult {
        kNotImplemented
    }
}

#[test]
fn a_vst3_window_asks_for_a_size_by_the_name_that_its_host_knows() {
    let _turn = alone();
    let hosted = Hosted::new();
    let (view, frame) = (hosted.view(), ComWrapper::new(Frame::default()));
    let handed = frame.to_com_ptr::<IPlugFrame>().unwrap();
    // SAFETY: the frame outlives the window.
    assert_eq!(unsafe { view.setFrame(handed.as_ptr()) }, kResultOk);
    let parent = Parent::new(POINTS.0, POINTS.1);
    attach(&view, &parent);
    let tree = parent.connection.query_tree(parent.window).unwrap().reply().unwrap();
    let wanted = (POINTS.0 + 20, POINTS.1 + 30);
    let change = ConfigureWindowAux::new().width(wanted.0).height(wanted.1);
    parent.connection.configure_window(tree.children[0], &change).unwrap().check().unwrap();
    let begun = Instant::now();
    while frame.asked.borrow().is_empty() {
        assert!(begun.elapsed() < PATIENCE, "nobody asks");
        let handlers = frame.handlers.borrow().clone();
        // SAFETY: a call that a host makes.
        handlers.iter().for_each(|(handler, fd)| unsafe { handler.onFDIsSet(*fd) });
        thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(frame.asked.borrow()[..], [(view.as_ptr().addr(), wanted)]);
    remove(&view);
}
