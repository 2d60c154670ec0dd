//! A cymbal's plate and what its modes do to the air, worked out once for all that are alike.

use crate::cache::{Cache, Shared};
use serde::{Deserialize, Serialize};

use crate::air_load;
use crate::error::SpecError;
use crate::plate::free_disc::{FarPattern, FreeDisc, Radiated};
use crate::plate::{PlateModes, PlateSpec, PlateTables};
use crate::radiation::Radiator;
use crate::receiver::Receivers;
use crate::schema::SCHEMA;

/// A plate's modes and what each does to the air around.
#[derive(Serialize, Deserialize)]
pub struct SoundingPlate {
    /// The modes.
    pub plate: PlateModes,
    /// `[shell]`.
    pub radiated: Vec<Radiated>,
    /// What is heard of each from far away in every direction, `[shell]`.
    pub patterns: Vec<FarPattern>,
}

/// What has been worked out of late.
static PLATES: Cache<SoundingPlate> = Cache::new("plate", SCHEMA, 16);

impl SoundingPlate {
    /// That of a description, up to a frequency (Hz), heard from there.
    ///
    /// # Errors
    /// [`SpecError`] if the plate or the limit is out of range.
    pub fn of(
        plate_spec: &PlateSpec,
        receivers: &Receivers,
        limit_hz: f64,
    ) -> Result<Shared<SoundingPlate>, SpecError> {
        PLATES.get(&(*plate_spec, receivers, limit_hz), || {
            let plate = PlateModes::new(plate_spec, limit_hz)?;
            let (orders, extent) = plate.table_extent(limit_hz);
            let tables = PlateTables::new(orders, extent);
            let (radiated, patterns) = radiate(plate_spec, receivers, &plate, &tables).unzip();
            Ok(SoundingPlate { plate, radiated, patterns })
        })
    }
}

/// What each of the plate's shell modes does to the air around, `[shell]`.
fn radiate(
    spec: &PlateSpec,
    receivers: &Receivers,
    plate: &PlateModes,
    tables: &PlateTables,
) -> impl Iterator<Item = (Radiated, FarPattern)> {
    let highest = plate.shells.last().map_or(0.0, |shell| shell.omega);
    let finest = plate.flat.iter().flatten().map(|flat| flat.root).fold(0.0, f64::max);
    let trace = highest * spec.radius() / air_load::SPEED_OF_SOUND;
    let nodes = 12 + (0.7 * (finest + trace)) as usize;
    let disc = FreeDisc::new(spec.radius(), receivers.points(), nodes);
    let shapes = plate.radial_shapes(tables, disc.radii());
    plate.shells.iter().enumerate().map(move |(at, shell)| {
        let radial = &shapes[at * nodes..][..nodes];
        let wave = Radiator { m: shell.m, radial, omega: shell.omega };
        disc.radiate_around(&wave, plate.wave_number(shell))
    })
}
