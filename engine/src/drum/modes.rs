//! A drum's modes over its range of pitches: heads stretched, orders solved at every pitch, followed from one to the next.

use std::f64::consts::{PI, SQRT_2, TAU};

use serde::{Deserialize, Serialize};

use crate::air_load::{DENSITY, SPEED_OF_SOUND};
use crate::build_context::BuildContext;
use crate::drum::coupled::{CoupledMode, SLOWEST};
use crate::drum::heads::{BareHeads, MIDDLE, TunedHead, TunedHeads};
use crate::drum::spec::DrumSpec;
use crate::drum::tension_field::MIXED_FROM;
use crate::drum::tuned::{self, Grid, ModeAtPitch, PitchPosition, TunedMode};
use crate::error::SpecError;
use crate::high_band::{HighBandSpec, Receiver, SLICES, SLICES_UNDER_WIRES};
use crate::math::bessel::JTable;
use crate::receiver::Receivers;
use crate::shapes::{ShapeIndex, ShapeTable};
use crate::split::Splitting;
use crate::surface::contacts::STRIKER_PLACES;
use crate::surface::wires;

/// Up to so many times a drum's pitch its modes are heard one by one. *By ear*.
const HEARD_SINGLY: f64 = 10.0;

/// A mode with less of its energy than this in the heads is never heard.
const HEARD_SHARE: f64 = 1e-3;

/// Everything a drum is made from.
#[derive(Serialize, Deserialize)]
pub struct DrumModes {
    /// The heads.
    pub heads: TunedHeads,
    /// The drum's modes, pairs once, lowest first at the default pitch; then those that are mixed, lowest first in the
    /// middle of the range.
    pub modes: Vec<TunedMode>,
    /// How many are not mixed; all, if the heads are even.
    pub kept: usize,
}

/// The drum's modes of one order, followed through the pitches.
fn follow_order(heads: &TunedHeads, spec: &DrumSpec, m: u32, bessel: &JTable) -> Vec<TunedMode> {
    let air = heads.air(spec, m);
    let lowest = air.iter().flat_map(|air| &air.modes).map(|mode| mode.omega).find(|&omega| omega > 0.0);
    let grid = match lowest {
        Some(omega) if omega < TAU * HEARD_SINGLY * heads.scale.pitches()[MIDDLE] => Grid::Fine,
        Some(_) => Grid::Middle,
        None => Grid::Coarse,
    };
    let solved: Vec<Vec<CoupledMode>> =
        grid.pitches().map(|pitch| heads.solve(spec, m, bessel, air.as_ref(), pitch)).collect();
    let limit = TAU * spec.batter.modes_to_hz;
    let keep = |mode: &CoupledMode| {
        (SLOWEST..=limit).contains(&mode.omega) && mode.share[0] + mode.share[1] > HEARD_SHARE
    };
    tuned::follow(m, &solved, heads.head_shapes(m).len(), grid, keep)
}

impl DrumModes {
    /// Works a drum out. Tenths of a second.
    ///
    /// # Errors
    /// [`SpecError`] if the spec is out of range.
    pub fn new(spec: &DrumSpec) -> Result<DrumModes, SpecError> {
        let bare = BareHeads::new(spec)?;
        let tables = bare.tables();
        let heads = bare.tuned(spec, &tables);
        let orders = (0..=heads.orders()).zip(&tables);
        let modes: Vec<TunedMode> =
            orders.flat_map(|(m, table)| follow_order(&heads, spec, m, table)).collect();
        let [_, default, _] = spec.pitches();
        let place = heads.scale.place(default);
        let mixed_from = spec.is_uneven().then(|| TAU * MIXED_FROM * heads.scale.pitches()[MIDDLE]);
        let (mut modes, mut mixed): (Vec<_>, Vec<_>) =
            modes.into_iter().partition(|mode| mixed_from.is_none_or(|from| mode.reference.omega < from));
        modes.sort_by(|a, b| a.at(&place).omega.total_cmp(&b.at(&place).omega));
        mixed.sort_by(|a, b| a.reference.omega.total_cmp(&b.reference.omega));
        let kept = modes.len();
        modes.extend(mixed);
        Ok(DrumModes { heads, modes, kept })
    }

    /// Volume by which a mode without nodal diameters makes the drum smaller, per modal displacement, m2: that of
    /// the point in free air that loses as much by radiation as the mode does.
    ///
    /// # Real-time
    /// Linear in the head modes it mixes.
    pub fn volume(&self, mode: &TunedMode, place: &PitchPosition) -> f64 {
        let (first, near) = self.heads.batter.order(0);
        let volume = |head: &TunedHead, at: usize, skip: usize| -> f64 {
            let modes = head.membrane.modes()[at..].iter().take_while(|mode| mode.m == 0).enumerate();
            modes.map(|(i, head_mode)| mode.share(skip + i, place) * head.membrane.volume(head_mode)).sum()
        };
        let far = self.heads.resonant.as_ref().map_or(0.0, |head| volume(head, head.order(0).0, near));
        // Along the stroke is into the drum at the one and out of it at the other.
        let outlet = mode.outlet(place) * self.heads.batter.membrane.spec().area();
        let moved = volume(&self.heads.batter, first, 0) - far - outlet;
        let now = mode.at(place);
        // A point in free air loses half of what it would in a baffle.
        let volume = SQRT_2 * mode.monopole_area(place) * now.mass.sqrt();
        volume.min(most_volume(&now)).copysign(moved)
    }

    /// Shapes on the batter of every mode of the body, `[mode]`, pairs as two.
    pub fn batter_shapes(&self, splitting: Splitting) -> ShapeTable {
        self.shapes(&self.heads.batter, splitting)
    }

    /// Shapes on the resonant head, if there is one.
    pub fn resonant_shapes(&self, splitting: Splitting) -> Option<ShapeTable> {
        self.heads.resonant.as_ref().map(|head| self.shapes(head, splitting))
    }

    fn shapes(&self, head: &TunedHead, splitting: Splitting) -> ShapeTable {
        let mut index = Vec::new();
        for mode in &self.modes {
            let (radial, rows) = head.order(mode.m);
            let axis = splitting.axis(mode.m, 0);
            let members = Splitting::ROUND.members(mode.m, 0);
            index.extend(members.map(|(member, _)| ShapeIndex { radial, rows, m: mode.m, member, axis }));
        }
        let waves = head.membrane.modes().iter().map(|mode| mode.zero);
        let radial = head.membrane.radial_shapes(&ShapeTable::radii());
        ShapeTable::new(&radial, index).with_waves(head.membrane.spec().radius, waves)
    }

    /// What the batter does above its modes.
    pub fn high_band(&self, spec: &DrumSpec, context: &BuildContext) -> HighBandSpec {
        let Receivers { near, far } = context.receivers;
        let ear = Receiver { point: near, away: far, outside: spec.outside(), far: false };
        self.heads.batter.high_band(ear, context, (density(spec), STRIKER_PLACES, false))
    }

    /// What the resonant head does above its modes, for wires to set going.
    pub fn far_high_band(&self, spec: &DrumSpec, context: &BuildContext) -> Option<HighBandSpec> {
        let behind = spec.cavity().map_or(0.0, |cavity| cavity.depth);
        let Receivers { near, far } = context.receivers;
        let ear = Receiver { point: near.from_behind(behind), away: far, outside: spec.outside(), far: true };
        let head = self.heads.resonant.as_ref()?;
        Some(head.high_band(ear, context, (density(spec), wires::SECTIONS, true)))
    }
}

/// Slices in an octave of a drum's high bands.
fn density(spec: &DrumSpec) -> f64 {
    if spec.wires.is_some() { SLICES_UNDER_WIRES } else { SLICES }
}

/// The largest volume that a mode can displace per modal displacement, m2: a point in free air that moves it loses by radiation all that
/// the mode loses.
pub fn most_volume(mode: &ModeAtPitch) -> f64 {
    (8.0 * PI * SPEED_OF_SOUND * mode.sigma * mode.mass / DENSITY).sqrt() / mode.omega
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drum::ResonantSpec;
    use crate::kit_spec::KitSpec;
    use crate::reference;

    /// A small, tight bass drum whose front head has a port of that diameter, m.
    fn ported(port_diameter: Option<f64>) -> DrumModes {
        let kit = KitSpec::standard();
        let kick = kit.pieces.iter().find_map(|piece| piece.drum()).copied().unwrap();
        let batter = crate::drum::HeadSpec { modes_to_hz: 1500.0, ..kick.batter };
        let resonant = kick.resonant.map(|head| ResonantSpec { port_diameter, ..head });
        let [lowest_pitch_hz, pitch_hz, highest_pitch_hz] = [200.0, 200.0, 210.0];
        let spec = DrumSpec {
            diameter: 0.3,
            pitch_hz,
            lowest_pitch_hz,
            highest_pitch_hz,
            batter,
            resonant,
            tension_field: None,
            lugs: None,
            ..kick
        };
        DrumModes::new(&spec).unwrap()
    }

    #[test]
    fn a_port_is_helmholtzs_resonator_with_walls_that_give() {
        let (a, b, depth) = (0.15_f64, 0.0127, 18.0 * 0.0254);
        let drum = ported(Some(2.0 * b));
        let given: f64 = [Some(&drum.heads.batter), drum.heads.resonant.as_ref()]
            .into_iter()
            .flatten()
            .map(|head| PI * a.powi(4) / (8.0 * head.tensions[0]))
            .sum();
        let air = PI * a * a * depth / (DENSITY * SPEED_OF_SOUND * SPEED_OF_SOUND);
        let exact = (2.0 * b / (DENSITY * (air + given))).sqrt() / TAU;
        let lowest = drum.modes[0].at(&drum.heads.scale.place(200.0));
        let hz = lowest.omega / TAU;
        assert_eq!(drum.modes[0].m, 0);
        assert!((hz / exact - 1.0).abs() < 0.03, "{hz} {exact}");
        // Without it nothing is as low.
        let closed = ported(None);
        assert!(closed.modes[0].at(&closed.heads.scale.place(200.0)).omega > 2.0 * lowest.omega);
    }

    #[test]
    fn heads_give_way_to_the_air_that_a_port_lets_in() {
        // Far below the heads' own modes they follow the pressure, which is highest when the port's air has come in.
        let drum = ported(Some(0.0254));
        let place = drum.heads.scale.place(200.0);
        let lowest = &drum.modes[0];
        let (_, near) = drum.heads.batter.order(0);
        let [batter, far] = [0, near].map(|head| lowest.share(head, &place));
        let port = lowest.outlet(&place);
        assert!(port * far < 0.0 && port * batter > 0.0, "{port} {far} {batter}");
        assert!(port.abs() > batter.abs() && port.abs() > far.abs());
    }

    #[test]
    fn volumes_send_out_what_modes_lose_at_every_pitch() {
        let mut far = 0.0_f64;
        for name in ["kick", "rack-tom", "floor-tom"] {
            let spec = reference::drum(name);
            let bare = BareHeads::new(&spec).unwrap();
            let tables = bare.tables();
            let heads = bare.tuned(&spec, &tables);
            let drum = DrumModes::new(&spec).unwrap();
            let air = heads.air(&spec, 0);
            for pitch in [0, MIDDLE, tuned::PITCHES - 1] {
                let solved = heads.solve(&spec, 0, &tables[0], air.as_ref(), pitch);
                let place = heads.scale.place(heads.scale.pitches()[pitch]);
                for mode in drum.modes.iter().filter(|mode| mode.m == 0) {
                    let now = mode.at(&place);
                    let alone =
                        solved.iter().find(|alone| (alone.omega / now.omega - 1.0).abs() < 1e-9).unwrap();
                    let area = SQRT_2 * alone.monopole_area * now.mass.sqrt();
                    let volume = drum.volume(mode, &place).abs();
                    assert!((volume / area - 1.0).abs() < 1e-6, "{name} {pitch}: {volume} {area}");
                    far = far.max((mode.reference.monopole_area / alone.monopole_area).ln().abs());
                }
            }
        }
        // Where heads and air pass each other a mode is another one at the ends of the range than in the middle.
        assert!(far > 0.3);
    }
}
