use super::*;
use crate::contact::{Material, Tip};

const DT: f64 = 1.0 / 44_100.0;

fn chance() -> impl FnMut() -> f64 {
    let mut draw = fastrand::Rng::with_seed(1);
    move || draw.f64()
}

fn law(tip: Tip) -> ContactLaw {
    ContactLaw::new(&tip, &Material::FILM, 0.35)
}

fn steel() -> Tip {
    Tip::Solid { material: Material::STEEL, radius: 0.8e-3 }
}

/// Holds the forces that [`solve`] finds against the equations, which the sweeps solve one contact at a time.
fn check<const N: usize>(lanes: &ContactLanes<N>, compliances: &Compliances<N>) {
    let (mut fast, mut slow) = (lanes.clone(), lanes.clone());
    assert!(
        if lanes.all_hertz() {
            newton::<N, true>(&mut fast, compliances)
        } else {
            newton::<N, false>(&mut fast, compliances)
        },
        "Newton's method does not converge"
    );
    let mut solved = lanes.clone();
    solve(Kernels::detect(), &mut solved, compliances);
    sweep(&mut slow, compliances);
    let largest = slow.force.iter().fold(0.0_f64, |most, x| most.max(*x));
    for (i, row) in compliances.iter().enumerate() {
        // A sweep takes its force from a difference of compressions, and with it their rounding.
        let rounding = 1e-14 * lanes.before[i].abs().max(lanes.free[i].abs()) / row[i].max(1e-9);

        assert!(
            (fast.force[i] - slow.force[i]).abs() <= 1e-8 * largest + rounding,
            "{} {}",
            fast.force[i],
            slow.force[i]
        );
        assert!((fast.force[i] - solved.force[i]).abs() <= 1e-8 * largest, "instruction sets differ");
    }
}

/// Contacts like those under snare wires and sticks, `open` of the lanes unused.
fn wires<const N: usize>(laws: &[ContactLaw], open: usize) {
    let mut chance = chance();
    for _ in 0..300 {
        let mutual = 3e-7 * chance();
        let mut compliances = [[mutual; N]; N];
        let mut lanes = ContactLanes::<N>::APART;
        for i in 0..N - open {
            let before = 2e-6 * (chance() - 0.3);
            let free = before + 4e-6 * (chance() - 0.5);
            let step = ContactStep { before, free, compliance: 3e-6, lambda: 3.0, dt: 2e-5 };
            lanes.set(i, &laws[i % laws.len()], &step, 0.0);
            compliances[i][i] = step.compliance;
        }
        check(&lanes, &compliances);
    }
}

#[test]
fn any_number_of_contacts_obeys_the_equations() {
    let hertz = [law(steel())];
    wires::<1>(&hertz, 0);
    wires::<2>(&hertz, 0);
    wires::<4>(&hertz, 1);
    wires::<8>(&hertz, 1);
    wires::<16>(&hertz, 3);
}

#[test]
fn contacts_of_different_laws_obey_the_equations() {
    let felt = |exponent| law(Tip::Felt { stiffness: 3e8, exponent });
    let laws = [law(steel()), felt(2.5), felt(2.2)];
    wires::<1>(&laws[1..], 0);
    wires::<4>(&laws, 0);
    wires::<8>(&laws, 1);
}

#[test]
fn contacts_around_a_rim_obey_the_equations() {
    const POINTS: usize = 16;
    let tip = Tip::Solid { material: Material::BRONZE, radius: 1e-3 };
    let law = ContactLaw::new(&tip, &Material::BRONZE, 0.4);
    let mut chance = chance();
    for _ in 0..300 {
        let scattered: [[f64; POINTS]; POINTS] = [(); POINTS].map(|()| [(); POINTS].map(|()| chance() - 0.5));
        let compliances: Compliances<POINTS> = std::array::from_fn(|i| {
            std::array::from_fn(|j| if i == j { 5e-7 } else { 2e-8 * (scattered[i][j] + scattered[j][i]) })
        });
        // What a nonlinear force takes.
        let coupling: [f64; POINTS] = std::array::from_fn(|_| 2e-4 * (chance() - 0.5));
        let compliances: Compliances<POINTS> = std::array::from_fn(|i| {
            std::array::from_fn(|j| compliances[i][j] - coupling[i] * coupling[j] / 2.3)
        });
        let mut lanes = ContactLanes::<POINTS>::APART;
        for i in 0..POINTS {
            let before = 4e-6 * (chance() - 0.3);
            let mut step = ContactStep {
                before,
                free: before + 8e-6 * (chance() - 0.5),
                compliance: 0.0,
                lambda: 5.0,
                dt: DT,
            };
            // Some are open and stay where they are.
            if i == 3 || i == 4 {
                (step.before, step.free) = (-1e-4, -1e-4 + 1e-9 * (i - 3) as f64);
            }
            lanes.set(i, &law, &step, 0.0);
        }
        check(&lanes, &compliances);
    }
}

#[test]
fn points_that_move_as_one_obey_the_equations() {
    // Two points of a rigid body: a force at one moves the other as far as itself, which Jacobi's method cannot follow.
    let mut chance = chance();
    let law = law(steel());
    let compliances = [[3e-6 * 1.001, 3e-6], [3e-6, 3e-6 * 1.001]];
    for _ in 0..300 {
        let mut lanes = ContactLanes::<2>::APART;
        for i in 0..2 {
            let before = 2e-6 * (chance() - 0.3);
            let free = before + 4e-6 * (chance() - 0.5);
            lanes.set(i, &law, &ContactStep { before, free, compliance: 3e-6, lambda: 3.0, dt: 2e-5 }, 0.0);
        }
        solve(Kernels::detect(), &mut lanes, &compliances);
        let found = product(&compliances, &lanes.force);
        let d = [lanes.free[0] - found[0], lanes.free[1] - found[1]];
        let (forces, _) = lanes.gradient::<true>(&lanes.roots(), &d);
        let largest = lanes.force[0].max(lanes.force[1]);
        for (by_law, found) in forces.iter().zip(&lanes.force) {
            assert!((by_law.max(0.0) - found).abs() <= 1e-5 * largest, "{by_law} {found}");
        }
    }
}

#[test]
fn rivets_that_are_crowded_obey_the_equations() {
    // Eight beside each other: a force at one moves each other one by a quarter to two fifths as far as itself. Jacobi's method then
    // settled where the bodies agreed and the law did not, with forces half as large again.
    const RIVETS: usize = 8;
    let tip = Tip::Solid { material: Material::BRASS, radius: 0.045 };
    let law = ContactLaw::new(&tip, &Material::BRONZE, 0.7);
    let compliances: Compliances<RIVETS> = std::array::from_fn(|i| {
        std::array::from_fn(|j| if i == j { 5.5e-7 } else { 2.45e-7 - 1.5e-8 * i.abs_diff(j) as f64 })
    });
    let mut chance = chance();
    for _ in 0..1000 {
        let mut lanes = ContactLanes::<RIVETS>::APART;
        for i in 0..RIVETS {
            let step = ContactStep {
                before: 3e-9 + 5e-9 * chance(),
                free: 1.5e-8 + 1e-8 * chance(),
                compliance: 5.5e-7,
                lambda: 600.0,
                dt: DT,
            };
            lanes.set(i, &law, &step, 8e-3);
        }
        check(&lanes, &compliances);
    }
}

#[test]
fn newton_s_method_agrees_with_bounds_on_a_single_contact() {
    let mut chance = chance();
    for law in [law(steel()), law(Tip::Felt { stiffness: 3e8, exponent: 2.5 })] {
        for _ in 0..1000 {
            let scale = 10_f64.powf(-8.0 + 5.0 * chance());
            let before = scale * (chance() - 0.3);
            let step = ContactStep {
                before,
                free: before + scale * (chance() - 0.5),
                compliance: 10_f64.powf(-9.0 + 5.0 * chance()),
                lambda: 3.0 * chance(),
                dt: DT,
            };
            let mut lane = ContactLanes::<1>::APART;
            lane.set(0, &law, &step, 0.0);
            let (fast, slow) = (force(&law, &step), between_bounds(&lane, step.compliance));
            let rounding = 1e-14 * step.before.abs().max(step.free.abs()) / step.compliance;
            assert!((fast - slow).abs() <= 1e-9 * slow.abs() + rounding, "{step:?}: {fast} {slow}");
        }
    }
}
