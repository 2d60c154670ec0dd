//! What is to be built: a plan for the whole kit.

use std::sync::Arc;

use overhear_engine::error::SpecError;
use overhear_engine::kit::{RenderJob, RenderWorkers};
use overhear_engine::kit_spec::{InstrumentSpec, PieceBuild, PieceSpec};
use overhear_engine::piece::{BuildOptions, Piece, Quality};
use overhear_engine::slot::Slot;
use rayon::prelude::*;

use crate::denormals::flushed;
use crate::kit_document::KitDocument;
use crate::parameters::{Construction, Drives, parameters};
use crate::workers::{Deadline, Patience, Workers};

/// Whether the host waits for every buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pace {
    /// The host plays.
    RealTime,
    /// The host renders to a file.
    Offline,
}

/// Which kit is built, and how.
#[derive(Debug, Clone)]
pub struct BuildPlan {
    kit: Arc<KitDocument>,
    quality: Quality,
    worker_plan: WorkerPlan,
}

impl PartialEq for BuildPlan {
    fn eq(&self, other: &BuildPlan) -> bool {
        let built_alike = (self.quality, self.worker_plan) == (other.quality, other.worker_plan);
        // The same document most of the time, which need not be read.
        built_alike && (Arc::ptr_eq(&self.kit, &other.kit) || self.kit == other.kit)
    }
}

/// Who renders beside the audio thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WorkerPlan {
    /// How many.
    pub workers: usize,
    /// Whether the host waits for them.
    pub pace: Pace,
}

impl WorkerPlan {
    /// Nobody.
    pub const NOBODY: WorkerPlan = WorkerPlan { workers: 0, pace: Pace::RealTime };

    /// Starts the threads, if any are wanted.
    ///
    /// # Errors
    /// If the system starts no more threads.
    pub fn attach(self) -> std::io::Result<Option<Box<dyn RenderWorkers>>> {
        Ok(self.workers()?.map(|workers| -> Box<dyn RenderWorkers> { Box::new(workers) }))
    }

    /// Starts the threads, if any are wanted. The audio thread waits for them no longer than a deadline allows.
    ///
    /// # Errors
    /// If the system starts no more threads.
    pub fn hire_until(self, deadline: Arc<dyn Deadline>) -> std::io::Result<Option<Box<dyn RenderWorkers>>> {
        Ok(self.workers()?.map(|workers| -> Box<dyn RenderWorkers> { Box::new(workers.until(deadline)) }))
    }

    fn workers(self) -> std::io::Result<Option<Workers>> {
        if self.workers == 0 {
            return Ok(None);
        }
        let patience = match self.pace {
            Pace::RealTime => Patience::RealTime,
            Pace::Offline => Patience::Offline,
        };
        // In the floating point mode of the audio thread, or the bits would differ.
        let render = |job: &mut RenderJob| flushed(|| job.render());
        Ok(Some(Workers::new(self.workers, patience, render)?))
    }
}

impl BuildPlan {
    /// The plan of a kit that values in the parameters' units ask for, given by their place in the table.
    ///
    /// # Real-time
    /// No allocation; linear in the number of parameters.
    pub fn of(kit: Arc<KitDocument>, value: impl Fn(usize) -> f32, pace: Pace) -> BuildPlan {
        let mut plan = BuildPlan { kit, quality: Quality::default(), worker_plan: WorkerPlan::NOBODY };
        let mut offline = None;
        for (index, parameter) in parameters().iter().enumerate() {
            let Drives::Building(construction) = parameter.drives else { continue };
            let value = parameter.snap(value(index));
            let quality = |place: usize| Quality::ALL.get(place).copied();
            match construction {
                Construction::Quality => plan.quality = quality(value as usize).unwrap_or_default(),
                Construction::OfflineQuality => offline = (value as usize).checked_sub(1).and_then(quality),
                Construction::Workers => plan.worker_plan.workers = value as usize,
            }
        }
        if plan.worker_plan.workers > 0 {
            plan.worker_plan.pace = pace;
        }
        if pace == Pace::Offline {
            plan.quality = offline.unwrap_or(plan.quality);
        }
        plan
    }

    /// The kit.
    pub fn kit(&self) -> &Arc<KitDocument> {
        &self.kit
    }

    /// Whether it is the plan of this kit.
    pub fn is_of_kit(&self, kit: &Arc<KitDocument>) -> bool {
        Arc::ptr_eq(&self.kit, kit) || self.kit == *kit
    }

    /// Who renders beside the audio thread.
    pub fn worker_plan(&self) -> WorkerPlan {
        self.worker_plan
    }

    /// How every piece is built at a sample rate, Hz.
    pub fn options(&self, sample_rate: f64) -> BuildOptions {
        BuildOptions { quality: self.quality, ..BuildOptions::new(sample_rate) }
    }

    /// What building the piece of a slot depends on; none of an empty slot.
    pub fn build(&self, slot: Slot) -> Option<PieceBuild> {
        self.kit.kit.build(slot)
    }

    /// Builds every piece at a sample rate (Hz), in the order of the slots: side by side, but on this thread alone if it is one of a
    /// pool. Takes seconds, from the [cache folder](crate::cache) a tenth of one.
    ///
    /// # Errors
    /// [`SpecError`] of the first piece that cannot be built at that rate.
    pub fn pieces(&self, sample_rate: f64) -> Result<Vec<Piece>, SpecError> {
        // A worker of a pool that waited for others here would begin another of its jobs meanwhile, and hold one kit more.
        if rayon::current_thread_index().is_none() {
            return self.pieces_side_by_side(sample_rate);
        }
        let options = self.options(sample_rate);
        Slot::ALL
            .into_iter()
            .filter_map(|slot| Some(Piece::new(slot, &self.build(slot)?, &options)))
            .collect()
    }

    /// The same at a sample rate (Hz), on all threads of the pool that it is called in.
    ///
    /// # Errors
    /// As [`pieces`](Self::pieces).
    pub fn pieces_side_by_side(&self, sample_rate: f64) -> Result<Vec<Piece>, SpecError> {
        let options = self.options(sample_rate);
        let make = |slot| Some((slot, Piece::new(slot, &self.build(slot)?, &options)));
        // A bridge hands them out in their order, the longest first.
        let mut made: Vec<_> = self.longest_first().into_iter().par_bridge().filter_map(make).collect();
        made.sort_by_key(|(slot, _)| slot.index());
        made.into_iter().map(|(_, piece)| piece).collect()
    }

    /// The slots that have a piece. Building starts with the slowest piece, so that parallel builds end together.
    pub fn longest_first(&self) -> Vec<Slot> {
        let mut slots: Vec<(f64, Slot)> =
            self.kit.kit.slots().map(|(slot, piece)| (building_time(piece), slot)).collect();
        // Stable: pieces that take as long are built in the order of the kit.
        slots.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        slots.into_iter().map(|(_, slot)| slot).collect()
    }
}

/// About how long a piece takes to build, in no unit, only the order counts: the area of all its heads or plates, as up to a
/// frequency a body has modes in proportion to it. In the standard kit this is nearly the order that was measured: kick,
/// timpani, ride, floor tom, hi-hat, crash, rack tom, snare, splash; it has a tom before the ride and the snare before the crash.
fn building_time(piece: &PieceSpec) -> f64 {
    let area = |diameter: f64| diameter * diameter;
    match &piece.instrument {
        InstrumentSpec::Drum(drum) if drum.resonant.is_some() => 2.0 * area(drum.diameter),
        InstrumentSpec::Drum(drum) => area(drum.diameter),
        InstrumentSpec::Cymbal(cymbal) => area(cymbal.diameter),
        InstrumentSpec::HiHat(hat) => area(hat.top.diameter) + area(hat.bottom.diameter),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::find;

    fn plan(moved: &[(&str, f32)], pace: Pace) -> BuildPlan {
        let kit = Arc::new(KitDocument::standard());
        let mut values = parameters().map(|parameter| parameter.default);
        for (name, value) in moved {
            values[find(name, &kit.kit).unwrap()] = *value;
        }
        BuildPlan::of(kit, |index| values[index], pace)
    }

    #[test]
    fn the_default_plan_is_the_standard_kit_as_it_is_played() {
        let (kit, plan) = (KitDocument::standard().kit, plan(&[], Pace::RealTime));
        assert_eq!(plan.options(48e3), BuildOptions::new(48e3));
        for slot in Slot::ALL {
            assert_eq!(plan.build(slot), kit.build(slot));
        }
    }

    #[test]
    fn offline_has_a_quality_of_its_own_or_that_of_playing() {
        let quality = |moved: &[_], pace| plan(moved, pace).options(48e3).quality;
        assert_eq!(quality(&[], Pace::RealTime), Quality::Standard);
        assert_eq!(quality(&[], Pace::Offline), Quality::Offline);
        assert_eq!(quality(&[("quality", 2.0), ("offline_quality", 0.0)], Pace::Offline), Quality::High);
        assert_eq!(quality(&[("quality", 2.0), ("offline_quality", 1.0)], Pace::Offline), Quality::Eco);
    }

    #[test]
    fn workers_are_hired_as_many_as_are_wanted_and_nobody_by_default() {
        assert!(plan(&[], Pace::RealTime).worker_plan().attach().unwrap().is_none());
        let wanted = plan(&[("render_threads", 2.0)], Pace::Offline);
        assert_eq!(wanted.worker_plan(), WorkerPlan { workers: 2, pace: Pace::Offline });
        assert!(wanted.worker_plan().attach().unwrap().is_some());
        // Whoever renders them, pieces are the same.
        assert_eq!(wanted.options(48e3), plan(&[], Pace::Offline).options(48e3));
    }

    #[test]
    fn plans_are_equal_if_their_kits_are_whoever_holds_them() {
        let [one, other] = [plan(&[], Pace::RealTime), plan(&[], Pace::RealTime)];
        assert!(one == other && one.is_of_kit(other.kit()) && !Arc::ptr_eq(one.kit(), other.kit()));
        let mut changed = KitDocument::standard();
        changed.notes.set(38, None);
        let changed = BuildPlan { kit: Arc::new(changed), ..one.clone() };
        assert!(one != changed && !one.is_of_kit(changed.kit()));
    }

    #[test]
    fn all_pieces_are_built_and_large_ones_first() {
        let plan = plan(&[], Pace::RealTime);
        let names: Vec<String> =
            plan.longest_first().into_iter().map(|slot| plan.build(slot).unwrap().spec.name).collect();
        assert_eq!(
            names,
            ["kick", "timpani", "floor-tom", "ride", "snare", "hi-hat", "rack-tom", "crash", "splash"]
        );
    }

    #[test]
    fn pieces_come_in_the_order_of_the_slots_wherever_they_are_built() {
        let mut document = KitDocument::standard();
        document.kit.pieces.retain(|piece| ["splash", "rack-tom"].contains(&&*piece.name));
        let kit = Arc::new(document);
        let values = parameters().map(|parameter| parameter.default);
        let plan = BuildPlan::of(kit.clone(), |index| values[index], Pace::RealTime);
        let slots: Vec<Slot> = kit.kit.slots().map(|(slot, _)| slot).collect();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        for pieces in [plan.pieces(44_100.0), pool.install(|| plan.pieces(44_100.0))] {
            assert_eq!(pieces.unwrap().iter().map(Piece::slot).collect::<Vec<_>>(), slots);
        }
        assert!(plan.pieces(f64::NAN).is_err());
    }
}
