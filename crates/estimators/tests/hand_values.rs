//! Parts of walks against values by hand. They stand here and not beside the code, so that kernels are compiled once.

use std::sync::Arc;

use media::{Medium, Piecewise};
use numeric::Span;
use numeric::geometry::{Point, exit};
use numeric::pack::WIDTH;
use numeric::rng::{Address, LANES, PACKS};
use theory::ParticleRule;
use theory::problems::Rod;
use theory::problems::rod::channels;
use trueflight_estimators::rod::walk::{InRod, Particle, RuleAndRoulette};
use trueflight_estimators::sphere::connect::cone;
use trueflight_estimators::transmittance::scoring::{Score, Share};
use trueflight_estimators::transmittance::{
    next_flight::NextFlight, unidirectional_mis::UnidirectionalMis,
};
use trueflight_estimators::walks::Walk;
use trueflight_estimators::walks::slots::Slots;
use trueflight_estimators::walks::steps::{roulette, turned};

#[test]
fn every_draw_has_one_slot_and_lanes_take_turns() {
    for (count, turn) in [(1, 0), (5, 14), (16, 3), (45, 7)] {
        let mut lanes = vec![None; count];
        for pack in 0..PACKS {
            let (mut slots, mut over) = (Slots::new(count, turn, pack), 0);
            // Lanes end in every second step.
            for ended in [0b0101_0101, 0b1010_1010].into_iter().cycle() {
                if !slots.are_open() {
                    break;
                }
                over |= slots.fill(ended, |slot| {
                    assert_eq!(slot.steps, u32::from(slot.draw >= LANES || ended == 0b1010_1010));
                    let lane = pack * WIDTH + slot.lane;
                    assert_eq!(lanes[slot.draw].replace(lane), None);
                });
                slots.step();
            }
            let mine = |lane: usize| lane / WIDTH == pack;
            let open = (0..count.min(LANES)).filter(|draw| mine((turn + draw) % LANES));
            assert_eq!(over.count_ones() as usize, open.count());
        }
        let expected = (0..count).map(|draw| Some((turn + draw) % LANES));
        assert!(lanes.into_iter().eq(expected), "{count} from {turn}");
    }
}

#[test]
fn places_score_their_shares_by_weight() {
    // σ_t = 3σ̄/4, then 2σ̄: weights 1, 1/4, −1/4.
    let score = Score::open(0.5).collided(0.75, 0.6).collided(2.0, 0.8);
    assert!((score.total::<NextFlight>() - (0.5 + 0.15 - 0.2)).abs() < 1e-15);
    assert!((score.total::<UnidirectionalMis>() - (0.5 + 0.15 - 0.4)).abs() < 1e-15);
}

#[test]
fn shares_are_those_of_flight_and_next_flight() {
    let left = 2f64.ln();
    assert!((NextFlight.of(left) - 0.5).abs() < 1e-15);
    // The balance heuristic of v = 1/2 against 1.
    assert!((UnidirectionalMis.of(left) - 1.0 / 3.0).abs() < 1e-15);
    assert_eq!([NextFlight.of(1e9), UnidirectionalMis.of(1e9)], [0.0; 2]);
}

#[test]
fn directions_turn_as_on_a_sphere() {
    // Straight on and straight back, whatever the azimuth.
    for azimuth in [-1.0, 0.3, 1.0] {
        assert_eq!(turned(0.6, 1.0, azimuth), 0.6);
        assert_eq!(turned(0.6, -1.0, azimuth), -0.6);
        // From the normal the new cosine is that of the deflection.
        assert_eq!(turned(1.0, 0.25, azimuth), 0.25);
    }
    // cos 60° by 30° towards the normal and away from it: cos 30°, cos 90°.
    let (half, long) = (0.5, 0.75f64.sqrt());
    assert!((turned(half, long, 1.0) - long).abs() < 1e-15);
    assert!(turned(half, long, -1.0).abs() < 1e-15);
}

#[test]
fn a_ray_meets_a_sphere_before_it_and_none_behind() {
    let centre = Point([0.0, 0.0, 2.0]);
    let up = Point([0.0, 0.0, 1.0]);
    let meets = |origin: [f64; 3], direction: Point| {
        let (misses, near) = exit::meets(centre, 0.5, origin, direction.0);
        (!misses).then_some(near)
    };
    assert_eq!(meets([0.0; 3], up), Some(1.5));
    assert_eq!(meets([0.0; 3], up * -1.0), None);
    assert_eq!(meets([0.6, 0.0, 0.0], up), None);
    // 3-4-5.
    let aside = meets([0.3, 0.0, 0.0], up).expect("it meets");
    assert!((aside - 1.6).abs() < 1e-15);
}

#[test]
fn the_cone_of_a_sphere_is_half_space_at_its_surface_and_shrinks_like_the_square() {
    assert_eq!(cone(0.3, 0.3), 1.0);
    assert!((cone(0.6, 1.0) - 0.2).abs() < 1e-15);
    assert!((cone(1e-6, 1.0) - 0.5e-12).abs() < 1e-24);
}

#[test]
fn a_particle_is_seen_at_its_end_and_by_its_order() {
    let span = Span::new(0.0, 1.0);
    let [albedo, forward] = [0.5; 2].map(|value| Piecewise::constant(value, span));
    let medium = Medium::new(Arc::new(Piecewise::constant(0.7, span)), span, span);
    let rod = Rod::new(medium, &albedo, &forward, channels(1, true, Some(2)));
    let walk =
        InRod { rod: &rod, steps: RuleAndRoulette { rule: ParticleRule::Analog, roulette: None } };
    let values = |particle: &Particle<f64>, left| {
        let value = |channel| walk.value(particle, left, channel);
        (0..walk.channels()).map(value).collect::<Vec<_>>()
    };
    let flux = [0.3, 0.0, 0.0, 0.0];
    let reflected = Particle { is_forward: false, weight: 0.5, order: 1.0, absorbed: 0.2, flux };
    // Flux, T0, R1, T1, R2, T2, absorbed, R, T.
    assert_eq!(values(&reflected, true), [0.3, 0.0, 0.5, 0.0, 0.0, 0.0, 0.2, 0.5, 0.0]);
    assert_eq!(values(&reflected, false)[6..], [0.2, 0.0, 0.0]);
    let often = Particle { order: 7.0, ..reflected };
    assert_eq!(values(&often, true)[1..6], [0.0; 5]);
}

#[test]
fn what_roulette_takes_it_gives_back() {
    let mut rng = Address { seed: 1, experiment: 2, block: 3, lane: 4 }.stream();
    let mut kept =
        |mut weight: f64| roulette::<f64>(Some(0.4), true, &mut weight, &mut rng).then_some(weight);
    assert_eq!(kept(0.4), Some(0.4));
    assert_eq!(kept(0.0), None);
    for weight in [0.1, -0.3] {
        let draws = 100_000;
        let mean = (0..draws).filter_map(|_| kept(weight)).sum::<f64>() / f64::from(draws);
        // A standard deviation of 0.0006 at most.
        assert!((mean - weight).abs() < 0.004, "{mean} for {weight}");
    }
}
