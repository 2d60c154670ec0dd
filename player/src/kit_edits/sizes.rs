//! Sizes of a piece as drummers say them: in inches or millimetres, grams, hertz, degrees.

use std::f64::consts::TAU;

use overhear_engine::cymbal::CymbalSpec;
use overhear_engine::drum::spec::{DrumSpec, ShellSpec};
use overhear_engine::error::SpecError;
use overhear_engine::kit_spec::{InstrumentSpec, PieceSpec};
use overhear_engine::slot::Slot;
use overhear_engine::surface::rivets::RivetsSpec;

use crate::kit_document::KitDocument;

use super::{Edit, change};

mod text;

/// A size of a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// Across the head or the plate.
    Diameter,
    /// From end to end of a shell.
    Depth,
    /// Of the air in a kettle.
    Volume,
    /// To which a drum is tuned, with its lowest and highest pitch.
    Pitch,
    /// Of the resonant head over the batter head's.
    PitchRatio,
    /// Of the hole in the resonant head.
    Opening,
    /// Of the hole in the shell.
    Vent,
    /// Of a cymbal, of the upper one of a hi-hat.
    Weight,
    /// Of the lower one of a hi-hat.
    LowerWeight,
    /// Across the lower cymbal of a stack.
    LowerDiameter,
    /// Force that presses the upper cymbal of a stack on the lower one.
    Pressed,
    /// Rise of a cymbal's bow.
    Bow,
    /// Thickness of a cymbal at its rim.
    Rim,
    /// Across the bell of a cymbal, and its rise over the bow.
    Bell,
    /// See `Bell`.
    BellRise,
    /// Across what a china's upturned rim surrounds, and the rise of that rim.
    Flange,
    /// See `Flange`.
    FlangeRise,
    /// How uneven the hammer leaves a cymbal's thickness.
    Hammering,
    /// How unevenly a head is stretched.
    Unevenness,
    /// Number of lugs, where they are counted.
    Lugs,
    /// How far the pulls of a drum's lugs are apart.
    LugTuning,
    /// How many rivets a cymbal has.
    Rivets,
    /// Of one of them.
    RivetWeight,
    /// Where they are, a share of the radius.
    RivetPlace,
    /// The arc that they are spread over; all of the circle if they are spread evenly.
    RivetArc,
    /// How far one can rise.
    RivetPlay,
    /// To the drummer's right, from the middle of the kit.
    Right,
    /// Over the floor.
    Height,
    /// Toward the audience.
    Forward,
}

/// What a size is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Measure {
    Length,
    Volume,
    Mass,
    Thickness,
    Pitch,
    Ratio,
    Percent,
    Count,
    Force,
    /// Of what weighs a gram or two.
    Grams,
    Angle,
}

/// Units of lengths on screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Units {
    /// Inches, as drums are sold.
    #[default]
    Inches,
    /// Millimetres.
    Millimetres,
}

/// A value that is not accepted.
#[derive(Debug, Clone, PartialEq)]
pub struct Refusal {
    /// The value, what is accepted, and why.
    pub words: String,
    /// The nearest value that is, in SI units.
    pub nearest: Option<f64>,
}

impl Size {
    /// All of them.
    pub const ALL: [Size; 29] = [
        Size::Diameter,
        Size::Depth,
        Size::Volume,
        Size::Pitch,
        Size::PitchRatio,
        Size::Opening,
        Size::Vent,
        Size::Weight,
        Size::LowerWeight,
        Size::LowerDiameter,
        Size::Pressed,
        Size::Bow,
        Size::Rim,
        Size::Bell,
        Size::BellRise,
        Size::Flange,
        Size::FlangeRise,
        Size::Hammering,
        Size::Unevenness,
        Size::Lugs,
        Size::LugTuning,
        Size::Rivets,
        Size::RivetWeight,
        Size::RivetPlace,
        Size::RivetArc,
        Size::RivetPlay,
        Size::Right,
        Size::Height,
        Size::Forward,
    ];

    /// What it is called on screen.
    pub fn label(self) -> &'static str {
        match self {
            Size::Diameter => "Diameter",
            Size::Depth => "Depth",
            Size::Volume => "Kettle",
            Size::Pitch => "Pitch",
            Size::PitchRatio => "Resonant pitch",
            Size::Opening => "Port",
            Size::Vent => "Vent",
            Size::Weight => "Weight",
            Size::LowerWeight => "Lower weight",
            Size::LowerDiameter => "Lower diameter",
            Size::Pressed => "Pressed by",
            Size::Bow => "Bow",
            Size::Rim => "Rim thickness",
            Size::Bell => "Bell",
            Size::BellRise => "Bell height",
            Size::Flange => "Flat up to",
            Size::FlangeRise => "Rim turns up",
            Size::Hammering => "Hammering",
            Size::Unevenness => "Uneven tension",
            Size::Lugs => "Lugs",
            Size::LugTuning => "Lugs differ by",
            Size::Rivets => "Rivets",
            Size::RivetWeight => "Rivet weight",
            Size::RivetPlace => "Rivets at",
            Size::RivetArc => "Rivets along",
            Size::RivetPlay => "Rivet play",
            Size::Right => "Right",
            Size::Height => "Height",
            Size::Forward => "Forward",
        }
    }

    fn measure(self) -> Measure {
        match self {
            Size::Volume => Measure::Volume,
            Size::Weight | Size::LowerWeight => Measure::Mass,
            Size::Pitch => Measure::Pitch,
            Size::PitchRatio => Measure::Ratio,
            Size::Rim | Size::RivetPlay => Measure::Thickness,
            Size::Hammering | Size::Unevenness | Size::LugTuning | Size::RivetPlace => Measure::Percent,
            Size::Lugs | Size::Rivets => Measure::Count,
            Size::Pressed => Measure::Force,
            Size::RivetWeight => Measure::Grams,
            Size::RivetArc => Measure::Angle,
            _ => Measure::Length,
        }
    }

    /// The field of a kit file that it is, as the end of its path; nothing where that is measured otherwise.
    fn field(self) -> &'static str {
        match self {
            Size::Diameter | Size::LowerDiameter => "diameter_m",
            Size::Pressed => "pressed_n",
            Size::Depth => "depth_m",
            Size::Volume => "volume_m3",
            Size::Pitch => "pitch_hz",
            Size::PitchRatio => "pitch_ratio",
            Size::Opening => "port_diameter_m",
            Size::Vent => "vent_diameter_m",
            Size::Weight | Size::LowerWeight => "mass_kg",
            Size::Bow => "bow_m",
            Size::Rim | Size::Bell | Size::Flange => "",
            Size::BellRise => "bell.rise_m",
            Size::FlangeRise => "flange.rise_m",
            Size::Hammering => "hammering.rms",
            Size::Unevenness => "tension_field.rms",
            Size::Lugs => "lugs.count",
            Size::LugTuning => "lugs.rms",
            Size::Rivets => "rivets.number",
            Size::RivetWeight => "rivets.mass_kg",
            Size::RivetPlace => "rivets.radius",
            Size::RivetArc => "rivets.arc_rad",
            Size::RivetPlay => "rivets.play_m",
            Size::Right => "centre_m.x",
            Size::Height => "centre_m.y",
            Size::Forward => "centre_m.z",
        }
    }

    /// The size of a piece in SI units, if it has it.
    pub fn of(self, piece: &PieceSpec) -> Option<f64> {
        let centre = piece.place.centre;
        match (self, &piece.instrument) {
            (Size::Right, _) => Some(centre[0]),
            (Size::Height, _) => Some(centre[1]),
            (Size::Forward, _) => Some(centre[2]),
            (Size::Diameter, instrument) => Some(2.0 * instrument.radius()),
            (Size::Depth, InstrumentSpec::Drum(drum)) => match drum.shell {
                Some(ShellSpec::Cylinder { depth, .. }) => Some(depth),
                _ => None,
            },
            (Size::Volume, InstrumentSpec::Drum(drum)) => match drum.shell {
                Some(ShellSpec::Kettle { volume, .. }) => Some(volume),
                _ => None,
            },
            (Size::Pitch, InstrumentSpec::Drum(drum)) => Some(drum.pitch_hz),
            (Size::PitchRatio, InstrumentSpec::Drum(drum)) => drum.resonant.map(|head| head.pitch_ratio),
            (Size::Opening, InstrumentSpec::Drum(drum)) => drum.resonant.and_then(|head| head.port_diameter),
            (Size::Vent, InstrumentSpec::Drum(drum)) => drum.shell.and_then(|shell| shell.vent_diameter()),
            (Size::Unevenness, InstrumentSpec::Drum(drum)) => drum.tension_field.map(|field| field.rms),
            (Size::Lugs, InstrumentSpec::Drum(drum)) => drum.lugs.map(|lugs| f64::from(lugs.count)),
            (Size::LugTuning, InstrumentSpec::Drum(drum)) => drum.lugs.map(|lugs| lugs.rms),
            (_, InstrumentSpec::Cymbal(cymbal)) => self.of_cymbal(cymbal),
            (Size::LowerWeight, InstrumentSpec::HiHat(hat)) => Some(hat.bottom.mass),
            (Size::LowerDiameter, InstrumentSpec::HiHat(hat)) => hat.pressed.map(|_| hat.bottom.diameter),
            (Size::Pressed, InstrumentSpec::HiHat(hat)) => hat.pressed,
            (_, InstrumentSpec::HiHat(hat)) => self.of_cymbal(&hat.top),
            _ => None,
        }
    }

    fn of_cymbal(self, cymbal: &CymbalSpec) -> Option<f64> {
        match self {
            Size::Weight => Some(cymbal.mass),
            Size::Bow => Some(cymbal.bow),
            Size::Rim => Some(rim(cymbal)),
            Size::Bell => cymbal.bell.map(|bell| 2.0 * bell.radius),
            Size::BellRise => cymbal.bell.map(|bell| bell.rise),
            Size::Flange => cymbal.flange.map(|flange| 2.0 * flange.radius),
            Size::FlangeRise => cymbal.flange.map(|flange| flange.rise),
            Size::Hammering => cymbal.hammering.map(|hammering| hammering.rms),
            Size::Rivets => cymbal.rivets.map(|rivets| f64::from(rivets.number)),
            Size::RivetWeight => cymbal.rivets.map(|rivets| rivets.mass),
            Size::RivetPlace => cymbal.rivets.map(|rivets| rivets.radius),
            Size::RivetArc => cymbal.rivets.map(|rivets| rivets.arc.unwrap_or(TAU)),
            Size::RivetPlay => cymbal.rivets.map(|rivets| rivets.play),
            _ => None,
        }
    }

    /// Changes a piece that has this size. A larger drum keeps the tension of its heads, a larger cymbal its thickness and
    /// its form.
    fn set(self, piece: &mut PieceSpec, value: f64) {
        let centre = &mut piece.place.centre;
        match (self, &mut piece.instrument) {
            (Size::Right, _) => centre[0] = value,
            (Size::Height, _) => centre[1] = value,
            (Size::Forward, _) => centre[2] = value,
            (_, InstrumentSpec::Drum(drum)) => self.set_drum(drum, value),
            (Size::LowerWeight, InstrumentSpec::HiHat(hat)) => hat.bottom.mass = value,
            (Size::LowerDiameter, InstrumentSpec::HiHat(hat)) => widen(&mut hat.bottom, value),
            (Size::Pressed, InstrumentSpec::HiHat(hat)) => hat.pressed = hat.pressed.map(|_| value),
            (Size::Diameter, InstrumentSpec::HiHat(hat)) => {
                let by = value / hat.top.diameter;
                let below = if hat.pressed.is_some() { by * hat.bottom.diameter } else { value };
                widen(&mut hat.top, value);
                widen(&mut hat.bottom, below);
            }
            (Size::Bow | Size::Rim | Size::Bell | Size::BellRise, InstrumentSpec::HiHat(hat)) => {
                [&mut hat.top, &mut hat.bottom].into_iter().for_each(|cymbal| self.set_cymbal(cymbal, value));
            }
            (_, InstrumentSpec::HiHat(hat)) => self.set_cymbal(&mut hat.top, value),
            (_, InstrumentSpec::Cymbal(cymbal)) => self.set_cymbal(cymbal, value),
        }
    }

    fn set_drum(self, drum: &mut DrumSpec, value: f64) {
        let tune = |drum: &mut DrumSpec, by: f64| {
            for pitch in [&mut drum.pitch_hz, &mut drum.lowest_pitch_hz, &mut drum.highest_pitch_hz] {
                *pitch *= by;
            }
        };
        match (self, &mut drum.shell, &mut drum.resonant) {
            (Size::Diameter, shell, resonant) => {
                let by = value / drum.diameter;
                if let Some(ShellSpec::Kettle { volume, .. }) = shell {
                    *volume *= by.powi(3);
                }
                if let Some(port) = resonant.as_mut().and_then(|head| head.port_diameter.as_mut()) {
                    *port *= by;
                }
                drum.diameter = value;
                tune(drum, 1.0 / by);
            }
            (Size::Depth, Some(ShellSpec::Cylinder { depth, .. }), _) => *depth = value,
            (Size::Volume, Some(ShellSpec::Kettle { volume, .. }), _) => *volume = value,
            (Size::Pitch, ..) => {
                let by = value / drum.pitch_hz;
                tune(drum, by);
                drum.pitch_hz = value;
            }
            (Size::PitchRatio, _, Some(head)) => head.pitch_ratio = value,
            (Size::Opening, _, Some(head)) => head.port_diameter = Some(value),
            (Size::Vent, Some(shell), _) => *shell = shell.vented(Some(value)),
            (Size::Unevenness, ..) => drum.tension_field.iter_mut().for_each(|field| field.rms = value),
            (Size::Lugs, ..) => drum.lugs.iter_mut().for_each(|lugs| lugs.count = value.round() as u32),
            (Size::LugTuning, ..) => drum.lugs.iter_mut().for_each(|lugs| lugs.rms = value),
            _ => {}
        }
    }

    fn set_cymbal(self, cymbal: &mut CymbalSpec, value: f64) {
        match self {
            Size::Diameter => widen(cymbal, value),
            Size::Weight => cymbal.mass = value,
            Size::Bow => cymbal.bow = value,
            Size::Rim => cymbal.taper = taper(cymbal, value),
            Size::Bell => cymbal.bell.iter_mut().for_each(|bell| bell.radius = 0.5 * value),
            Size::BellRise => cymbal.bell.iter_mut().for_each(|bell| bell.rise = value),
            Size::Flange => cymbal.flange.iter_mut().for_each(|flange| flange.radius = 0.5 * value),
            Size::FlangeRise => cymbal.flange.iter_mut().for_each(|flange| flange.rise = value),
            Size::Hammering => cymbal.hammering.iter_mut().for_each(|hammering| hammering.rms = value),
            _ => cymbal.rivets.iter_mut().for_each(|rivets| self.set_rivets(rivets, value)),
        }
    }

    fn set_rivets(self, rivets: &mut RivetsSpec, value: f64) {
        match self {
            Size::Rivets => rivets.number = value.round() as u32,
            Size::RivetWeight => rivets.mass = value,
            Size::RivetPlace => rivets.radius = value,
            // All of the circle, within half a degree.
            Size::RivetArc => rivets.arc = Some(value).filter(|&arc| arc < 0.999 * TAU),
            Size::RivetPlay => rivets.play = value,
            _ => {}
        }
    }

    /// The nearest value that a hand which drags comes to: half inches, or 10 mm.
    pub fn snapped(self, value: f64, units: Units) -> f64 {
        let step = match units {
            Units::Inches => 0.5 * INCH,
            Units::Millimetres => 0.01,
        };
        (value / step).round() * step
    }
}

/// An inch, m.
const INCH: f64 = 0.0254;

/// A degree, rad.
const DEGREE: f64 = TAU / 360.0;

/// Thickness of a cymbal at its rim, m. It falls evenly from the middle to the rim, so that the mean over the disc is the middle's
/// by `(1 + 2 taper) / 3`.
fn rim(cymbal: &CymbalSpec) -> f64 {
    3.0 * cymbal.taper * mean_thickness(cymbal) / (1.0 + 2.0 * cymbal.taper)
}

/// The taper that gives a thickness at the rim, m, with the weight as it is.
fn taper(cymbal: &CymbalSpec, rim: f64) -> f64 {
    // As thick there as three halves of the mean it would be in rings only.
    let share = (rim / (3.0 * mean_thickness(cymbal))).min(0.49);
    share / (1.0 - 2.0 * share)
}

/// m.
fn mean_thickness(cymbal: &CymbalSpec) -> f64 {
    cymbal.mass / (cymbal.alloy.density * std::f64::consts::PI * (0.5 * cymbal.diameter).powi(2))
}

fn widen(cymbal: &mut CymbalSpec, diameter: f64) {
    let by = diameter / cymbal.diameter;
    cymbal.diameter = diameter;
    cymbal.mass *= by * by;
    cymbal.bow *= by;
    if let Some(bell) = &mut cymbal.bell {
        (bell.radius, bell.rise) = (bell.radius * by, bell.rise * by);
    }
    if let Some(flange) = &mut cymbal.flange {
        (flange.radius, flange.rise) = (flange.radius * by, flange.rise * by);
    }
}

/// Gives the piece of a slot another size, SI units.
///
/// # Errors
/// [`Refusal`] with what is accepted and the nearest that is.
pub fn resize(
    document: &KitDocument,
    slot: Slot,
    size: Size,
    value: f64,
    units: Units,
) -> Result<Edit, Refusal> {
    let attempt = |value: f64| change(document, slot, |piece| size.set(piece, value));
    let error = match attempt(value) {
        Ok(edit) => return Ok(edit),
        Err(error) => error,
    };
    let present = document.kit.piece(slot).and_then(|piece| size.of(piece));
    let field = format!(".{}", size.field());
    let range = match &error {
        SpecError::OutOfRange { field: refused, min, max, .. } if refused.ends_with(&field) => {
            Some((*min, *max))
        }
        _ => None,
    };
    let bound = range.map(|(min, max)| value.clamp(min, max)).filter(|&bound| attempt(bound).is_ok());
    let nearest = bound.or_else(|| {
        let present = present?;
        // What there is works; what was asked for does not.
        let (mut works, mut fails) = (present, value);
        for _ in 0..40 {
            let middle = 0.5 * (works + fails);
            if attempt(middle).is_ok() { works = middle } else { fails = middle }
        }
        Some(rounded(size, works, present, units))
    });
    let title = document.kit.piece(slot).map_or("", |piece| piece.title.as_str());
    let label = size.label();
    let given = size.text(value, units);
    let why = range.map_or_else(
        || error.to_string(),
        |(min, max)| format!("accepted: {} to {}", size.text(min, units), size.text(max, units)),
    );
    let near = nearest.map_or(String::new(), |nearest| {
        format!("; the nearest that works is {}", size.text(nearest, units))
    });
    Err(Refusal { words: format!("{title}: {label} is {given}, {why}{near}"), nearest })
}

/// A value as it is shown, on the side of another one.
fn rounded(size: Size, value: f64, toward: f64, units: Units) -> f64 {
    let (scale, _, digits) = size.unit(units);
    let step = scale * 10.0_f64.powi(-(digits as i32));
    let steps = value / step;
    step * if toward < value { steps.floor() } else { steps.ceil() }
}
