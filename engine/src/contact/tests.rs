use super::solver::force as solved_force;
use super::*;

const RATES: [f64; 4] = [44_100.0, 48_000.0, 96_000.0, 192_000.0];

/// A mass flying into a rigid wall; what came of it.
struct Bounce {
    contact_time: f64,
    peak_force: f64,
    speed_out: f64,
}

fn bounce(law: &ContactLaw, mass: f64, speed: f64, dt: f64) -> Bounce {
    let compliance = dt * dt / (2.0 * mass);
    let lambda = law.lambda(speed);
    let (mut d, mut v, mut peak, mut time) = (0.0, speed, 0.0_f64, 0.0);
    for _ in 0..50_000_000 {
        let free = d + v * dt;
        let force = solved_force(law, &ContactStep { before: d, free, compliance, lambda, dt });
        let next = free - compliance * force;
        v -= force * dt / mass;
        peak = peak.max(force);
        // The crossing of zero within the last sample, on a straight line.
        time += if next < 0.0 { dt * d / (d - next) } else { dt };
        d = next;
        if d < 0.0 {
            break;
        }
    }
    Bounce { contact_time: time, peak_force: peak, speed_out: -v }
}

fn tips() -> Vec<(Tip, f64)> {
    let solid = |material, radius| Tip::Solid { material, radius };
    let felt = |stiffness, exponent| Tip::Felt { stiffness, exponent };
    vec![
        (solid(Material::HICKORY, 5e-3), 0.016),
        (solid(Material::HICKORY, 20e-3), 0.020),
        (solid(Material::NYLON, 4e-3), 0.016),
        (felt(6e8, 2.3), 0.110),
        (solid(Material::PLASTIC, 25e-3), 0.110),
        (felt(3e8, 2.5), 0.025),
        (felt(1e10, 2.5), 0.025),
        (felt(5e7, 2.2), 0.030),
    ]
}

#[test]
fn loss_comes_from_the_exact_relation_of_restitution() {
    for (e, r) in [(0.3, 3.0871), (0.6, 0.9749), (0.9, 0.1665), (0.05, 20.0)] {
        assert!((loss_of_restitution(e) - r).abs() < 5e-5, "{e}: {}", loss_of_restitution(e));
    }
    assert_eq!(loss_of_restitution(1.0), 0.0);
}

#[test]
fn steel_ball_on_steel_follows_hertz() {
    let tip = Tip::Solid { material: Material::STEEL, radius: 0.01 };
    let law = ContactLaw::new(&tip, &Material::STEEL, 1.0);
    let mass = 0.020;
    let mut times = Vec::new();
    for (speed, expected) in [(0.25, 76.4e-6), (1.0, 57.9e-6), (4.0, 43.9e-6), (16.0, 33.3e-6)] {
        let hertz = 2.943 * (1.25 * mass / law.stiffness).powf(0.4) * f64::powf(speed, -0.2);
        let got = bounce(&law, mass, speed, 2e-9).contact_time;
        assert!((got / hertz - 1.0).abs() < 2e-3, "{speed} m/s: {got} against {hertz}");
        assert!((got / expected - 1.0).abs() < 2e-3, "{speed} m/s: {got} against {expected}");
        times.push((speed, got));
    }
    let exponent = (times[3].1 / times[0].1).ln() / (times[3].0 / times[0].0).ln();
    assert!((exponent + 0.2).abs() < 1e-3, "{exponent}");
}

#[test]
fn lossless_tips_leave_a_rigid_wall_with_the_energy_they_brought() {
    for rate in RATES {
        for (tip, mass) in tips() {
            let law = ContactLaw::new(&tip, &Material::STEEL, 1.0);
            for speed in [0.1, 1.0, 5.0, 25.0] {
                let ratio = (bounce(&law, mass, speed, 1.0 / rate).speed_out / speed).powi(2);
                assert!((ratio - 1.0).abs() < 1e-9, "{tip:?} {speed} m/s at {rate} Hz: {ratio}");
            }
        }
    }
}

#[test]
fn restitution_at_a_fine_step_is_the_one_asked_for() {
    for (tip, mass) in tips() {
        for tenth in 1..=9 {
            let e = f64::from(tenth) / 10.0 + if tenth == 9 { 0.05 } else { 0.0 };
            let law = ContactLaw::new(&tip, &Material::FILM, e);
            let got = bounce(&law, mass, 3.0, 1e-8).speed_out / 3.0;
            assert!((got - e).abs() < 2e-3, "{tip:?}: {e} came back as {got}");
        }
    }
}

#[test]
fn restitution_of_felt_at_44_1_khz_is_within_a_hundredth() {
    for (tip, mass) in tips() {
        if matches!(tip, Tip::Solid { .. }) {
            continue;
        }
        for e in [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95] {
            let law = ContactLaw::new(&tip, &Material::FILM, e);
            for speed in [0.5, 2.0, 6.0] {
                let got = bounce(&law, mass, speed, 1.0 / 44_100.0).speed_out / speed;
                assert!((got - e).abs() < 0.01, "{tip:?} {speed} m/s: {e} came back as {got}");
            }
        }
    }
}

#[test]
fn felt_mallet_contact_at_44_1_khz_is_that_of_a_fine_step() {
    let law = ContactLaw::new(&Tip::Felt { stiffness: 3e8, exponent: 2.5 }, &Material::FILM, 0.8);
    let fine = bounce(&law, 0.030, 2.0, 1.0 / 705_600.0);
    let coarse = bounce(&law, 0.030, 2.0, 1.0 / 44_100.0);
    assert!((fine.contact_time / 3.46e-3 - 1.0).abs() < 0.01, "{}", fine.contact_time);
    assert!((fine.peak_force / 76.5 - 1.0).abs() < 0.01, "{}", fine.peak_force);
    assert!((coarse.contact_time / fine.contact_time - 1.0).abs() < 0.010);
    assert!((coarse.peak_force / fine.peak_force - 1.0).abs() < 0.015);
}

#[test]
fn work_done_is_the_change_of_the_potential() {
    let law = ContactLaw::new(&tips()[0].0, &Material::FILM, 1.0);
    for (before, free) in [(0.0, 1e-5), (1e-5, 1e-5 * (1.0 + 1e-6)), (1e-5, -2e-5), (-1e-5, 3e-5)] {
        let step = ContactStep { before, free, compliance: 1e-8, lambda: 0.0, dt: 1e-5 };
        let force = solved_force(&law, &step);
        let after = free - step.compliance * force;
        let work = force * (after - before);
        let stored = law.potential(after) - law.potential(before);
        assert!((work - stored).abs() < 1e-9 * law.potential(1e-5), "{before} {free}: {work} {stored}");
    }
}

#[test]
fn force_is_never_negative_and_vanishes_apart() {
    let law = ContactLaw::new(&tips()[3].0, &Material::FILM, 0.3);
    for before in [-1e-3, 0.0, 1e-4, 2e-3] {
        for free in [-5e-3, -1e-6, 0.0, 1e-3, 5e-3] {
            let step = ContactStep { before, free, compliance: 1e-8, lambda: 3.0, dt: 2e-5 };
            let force = solved_force(&law, &step);
            assert!(force >= 0.0);
            if before <= 0.0 && free <= 0.0 {
                assert_eq!(force, 0.0);
            }
        }
    }
}
