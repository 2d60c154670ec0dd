//! What a host hears of another kit, and that it hears nothing of one that is refused.

use std::sync::atomic::AtomicU32;

use clap_sys::ext::audio_ports::{
    CLAP_AUDIO_PORTS_RESCAN_NAMES, clap_audio_port_info, clap_host_audio_ports, clap_plugin_audio_ports,
};
use clap_sys::ext::note_name::clap_host_note_name;
use overhear_engine::kit_spec::InstrumentSpec;
use overhear_engine::slot::SLOTS;
use overhear_player::kit_document::KitDocument;
use overhear_player::kit_edits::{self, sizes};
use overhear_player::library;

use super::*;

/// Calls of the main thread that were asked for, names of outputs and of notes that were said to be others.
#[derive(Default)]
struct Told {
    asked: AtomicU32,
    outputs: AtomicU32,
    notes: AtomicU32,
}

impl Told {
    fn counts(&self) -> [u32; 3] {
        [&self.asked, &self.outputs, &self.notes].map(|count| count.load(Ordering::Relaxed))
    }
}

unsafe fn told<'a>(host: *const clap_host) -> &'a Told {
    // SAFETY: the host's data are these counts.
    unsafe { &*(*host).host_data.cast_const().cast() }
}

unsafe extern "C" fn asks(host: *const clap_host) {
    unsafe { told(host) }.asked.fetch_add(1, Ordering::Relaxed);
}

unsafe extern "C" fn knows(_host: *const clap_host, flag: u32) -> bool {
    flag == CLAP_AUDIO_PORTS_RESCAN_NAMES
}

unsafe extern "C" fn rescans(host: *const clap_host, flags: u32) {
    assert_eq!(flags, CLAP_AUDIO_PORTS_RESCAN_NAMES);
    unsafe { told(host) }.outputs.fetch_add(1, Ordering::Relaxed);
}

unsafe extern "C" fn renames(host: *const clap_host) {
    unsafe { told(host) }.notes.fetch_add(1, Ordering::Relaxed);
}

static PORTS_OF_HOST: clap_host_audio_ports =
    clap_host_audio_ports { is_rescan_flag_supported: Some(knows), rescan: Some(rescans) };
static NAMES_OF_HOST: clap_host_note_name = clap_host_note_name { changed: Some(renames) };

unsafe extern "C" fn extension(_host: *const clap_host, id: *const c_char) -> *const c_void {
    // SAFETY: the plugin asks by name.
    match unsafe { CStr::from_ptr(id) } {
        id if id == CLAP_EXT_AUDIO_PORTS => ptr::from_ref(&PORTS_OF_HOST).cast(),
        id if id == CLAP_EXT_NOTE_NAME => ptr::from_ref(&NAMES_OF_HOST).cast(),
        _ => ptr::null(),
    }
}

fn names_of_outputs(plugin: *const clap_plugin) -> Vec<String> {
    // SAFETY: the calls a host makes.
    unsafe {
        let ports = &*get_extension(plugin, CLAP_EXT_AUDIO_PORTS.as_ptr()).cast::<clap_plugin_audio_ports>();
        let mut info: clap_audio_port_info = std::mem::zeroed();
        let get = ports.get.unwrap();
        let count = ports.count.unwrap()(plugin, false);
        assert!(!get(plugin, count, false, &mut info) && !get(plugin, 0, true, &mut info));
        assert!(!get(plugin, 0, false, ptr::null_mut()));
        let named = (0..count).map(|index| {
            assert!(get(plugin, index, false, &mut info));
            CStr::from_ptr(info.name.as_ptr()).to_str().unwrap().to_owned()
        });
        named.collect()
    }
}

#[test]
fn outputs_have_the_titles_of_the_pieces_and_a_host_hears_of_other_ones_on_its_main_thread() {
    let counts = Box::<Told>::default();
    let host = clap_host {
        host_data: ptr::from_ref(&*counts).cast_mut().cast(),
        get_extension: Some(extension),
        request_callback: Some(asks),
        ..host()
    };
    let id = CString::new(overhear_player::MULTI_CLAP_ID).unwrap();
    // SAFETY: the calls a host makes, in its order.
    let (plugin, parameters) = unsafe {
        let plugin = create(&FACTORY, &host, id.as_ptr());
        assert!((*plugin).init.unwrap()(plugin));
        (plugin, guard(plugin).parameters.clone().unwrap())
    };
    let on_main_thread = || unsafe { (*plugin).on_main_thread.unwrap()(plugin) };
    on_main_thread();
    let [_, outputs, notes] = counts.counts();
    assert_eq!([outputs, notes], [0, 0]);
    let before = names_of_outputs(plugin);
    assert_eq!(before[1..4], ["Kick", "Snare", "Rack tom"]);
    assert_eq!((before.len(), &*before[10], &*before[17]), (PORTS, "Slot 10", "Overheads"));

    let mut changed = KitDocument::standard();
    changed.kit.pieces[1].title = "Gr\u{f6}\u{df}te Trommel".to_owned();
    let added = kit_edits::add(&changed, &library::instrument("crash-18-thin").unwrap()).unwrap();
    let asked = counts.counts()[0];
    let another = parameters.clone();
    let document = Arc::new(added.document);
    std::thread::scope(|threads| {
        threads.spawn(|| another.set_document(document.clone()).unwrap());
    });
    assert!(counts.counts()[0] > asked && counts.counts()[1..] == [0, 0], "another thread only asks");
    on_main_thread();
    assert_eq!(counts.counts()[1..], [1, 1]);
    on_main_thread();
    assert_eq!(counts.counts()[1..], [1, 1], "once");
    let after = names_of_outputs(plugin);
    assert_eq!(after[2], "Gr\u{f6}\u{df}te Trommel");
    assert_eq!(after[10], document.kit.pieces[9].title);
    assert_eq!((&after[3..10], &after[11..]), (&before[3..10], &before[11..]));

    // SAFETY: the host's last call.
    unsafe { (*plugin).destroy.unwrap()(plugin) };
    let told = counts.counts();
    parameters.set_document(Arc::new(KitDocument::standard())).unwrap();
    assert_eq!(counts.counts(), told, "a host that has destroyed it is not called");
}

#[test]
fn long_titles_end_at_a_whole_character() {
    let mut into = [1; 6];
    names::write("ab\u{20ac}\u{20ac}", &mut into);
    let bytes: Vec<u8> = into.iter().map(|byte| byte.cast_unsigned()).collect();
    assert_eq!(bytes, b"ab\xe2\x82\xac\0");
    names::write("abc\u{20ac}", &mut into);
    assert_eq!(into[3..], [0; 3]);
}

/// Edits that are refused, with what each would have come to.
fn refused() -> Vec<(&'static str, KitDocument)> {
    let standard = KitDocument::standard();
    let of = |name: &str| standard.kit.find(name).unwrap().0.index();
    let changed = |change: &dyn Fn(&mut KitDocument)| {
        let mut document = standard.clone();
        change(&mut document);
        document
    };
    vec![
        (
            "a 17th piece",
            changed(&|document| {
                for number in document.kit.pieces.len()..=SLOTS {
                    let mut piece = document.kit.pieces[of("splash")].clone();
                    piece.name = format!("splash-{number}");
                    piece.place.centre[1] += 0.1 * number as f64;
                    document.kit.pieces.push(piece);
                }
            }),
        ),
        (
            "a foil",
            changed(&|document| {
                if let InstrumentSpec::Cymbal(cymbal) = &mut document.kit.pieces[of("crash")].instrument {
                    cymbal.mass = 0.05;
                }
            }),
        ),
        (
            "a drum beyond its film",
            changed(&|document| {
                if let InstrumentSpec::Drum(drum) = &mut document.kit.pieces[of("rack-tom")].instrument {
                    (drum.lowest_pitch_hz, drum.pitch_hz, drum.highest_pitch_hz) = (310.0, 400.0, 1_100.0);
                }
            }),
        ),
        (
            "a cymbal in another one",
            changed(&|document| {
                document.kit.pieces[of("crash")].place = document.kit.pieces[of("ride")].place;
            }),
        ),
        (
            "a cymbal in a drum",
            changed(&|document| document.kit.pieces[of("splash")].place.centre = [0.0, 0.3, 0.0]),
        ),
    ]
}

#[test]
fn the_kit_that_sounds_is_untouched_by_edits_that_are_refused() {
    let mut instance = Instance::new(overhear_player::CLAP_ID);
    // SAFETY: the instance lives.
    let parameters = unsafe { guard(instance.plugin) }.parameters.clone().unwrap();
    let document = parameters.document();
    let before = struck(&mut instance, 1, |_, _| {});
    assert!(before[0][0].iter().any(|sample| *sample != 0.0));
    for (what, refused) in refused() {
        assert!(parameters.set_document(Arc::new(refused)).is_err(), "{what}");
        assert!(Arc::ptr_eq(&document, &parameters.document()), "{what}");
        assert!(struck(&mut instance, 1, |_, _| {}) == before, "{what}");
    }
    // As the page Build makes them, from the kit that is there.
    let slot = |name: &str| document.kit.find(name).unwrap().0;
    let mut full = (*document).clone();
    while full.kit.pieces.len() < SLOTS {
        full = kit_edits::duplicate(&full, slot("splash")).unwrap().document;
    }
    assert!(kit_edits::duplicate(&full, slot("splash")).is_err());
    let there = document.kit.find("ride").unwrap().1.place;
    assert!(kit_edits::change(&document, slot("crash"), |piece| piece.place = there).is_err());
    for (name, size, value) in [("crash", sizes::Size::Weight, 0.05), ("rack-tom", sizes::Size::Pitch, 900.0)]
    {
        assert!(sizes::resize(&document, slot(name), size, value, sizes::Units::Inches).is_err());
    }
    assert_eq!(*document, KitDocument::standard());
    // An activation waits for whatever would be built.
    // SAFETY: the calls a host makes, in its order.
    unsafe {
        let plugin = instance.plugin;
        (*plugin).stop_processing.unwrap()(plugin);
        (*plugin).deactivate.unwrap()(plugin);
        assert!((*plugin).activate.unwrap()(plugin, 48e3, 1, FRAMES as u32));
        assert!((*plugin).start_processing.unwrap()(plugin));
    }
    assert!(struck(&mut instance, 1, |_, _| {}) == before);
    assert!(struck(&mut Instance::new(overhear_player::CLAP_ID), 1, |_, _| {}) == before);
}
