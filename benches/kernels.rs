//! How long each kernel of a control period takes, on a moment of Study I.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use pleach::continuous::geometry::{Disc, convex_region, voronoi_half_planes};
use pleach::continuous::network::LinkReliability;
use pleach::continuous::network::acceptance::worst_load;
use pleach::continuous::network::routing::TIME_BUDGET;
use pleach::continuous::network::routing::adal::AdalSettings;
use pleach::continuous::network::routing::local::{LinkOffer, local_minimiser, weight};
use pleach::continuous::network::routing::repair::{Share, meet_demand};
use pleach::continuous::network::routing::rounds::{Method, Rounds};
use pleach::discrete::network::{Bid, Election, NoticeId};
use pleach_benches::scene::{Crowd, Scene};

/// Discs that detours keep out of are this many ρ wide.
const KEEP_OUT: f64 = 2.1;
/// Rounds after which the robots have told each other everything.
const ROUNDS_UNTIL_SETTLED: usize = 20;

/// Links and routes.
fn communication(criterion: &mut Criterion) {
    let scene = Scene::of_study_1();
    let (robot, site) = (scene.busiest(), &scene.site);
    let distances: Vec<f64> =
        scene.others(robot).iter().map(|other| (other - scene.position(robot)).norm()).collect();
    criterion.bench_function("link_reliability", |bencher| {
        bencher
            .iter(|| black_box(&distances).iter().map(|&d| site.link.reliability(d)).sum::<f64>())
    });

    let offers: Vec<LinkOffer> = distances
        .iter()
        .zip(&scene.snapshot.multipliers)
        .map(|(&distance, &neighbour_multiplier)| LinkOffer {
            reliability: site.link.reliability(distance),
            weight: weight(site.settings.slope_aversion, &site.link, distance),
            neighbour_multiplier,
        })
        .filter(|offer| offer.reliability > 0.0)
        .collect();
    let multiplier = scene.snapshot.multipliers[robot] + 1.0;
    let mut shares = Vec::new();
    criterion.bench_function("local_minimiser", |bencher| {
        bencher.iter(|| local_minimiser(multiplier, black_box(&offers), TIME_BUDGET, &mut shares))
    });

    let problem = scene.routing_problem();
    let methods = [
        ("dual_iteration", Method::AcceleratedDual),
        ("adal_iteration", Method::Adal(AdalSettings::default())),
    ];
    for (name, method) in methods {
        let mut rounds = Rounds::new(&problem, method);
        criterion.bench_function(name, |bencher| bencher.iter(|| rounds.iterate()));
    }

    let mut links: Vec<Share> = offers
        .iter()
        .map(|offer| Share { reliability: offer.reliability, share: 0.5 / offers.len() as f64 })
        .collect();
    let demand = 0.5;
    criterion.bench_function("repair_of_one_robot", |bencher| {
        bencher.iter(|| {
            links[0].share = 0.0;
            meet_demand(demand, black_box(&mut links), 0)
        })
    });
}

/// Ways, cells and moves.
fn motion(criterion: &mut Criterion) {
    let scene = Scene::of_study_1();
    let (leader, site) = (scene.leader(), &scene.site);
    let (from, goal) = (scene.position(leader), scene.goal());
    let destination = site.free_space.destination(goal);
    criterion.bench_function("geodesic_query", |bencher| {
        bencher.iter(|| site.free_space.geodesic_to(black_box(from), &destination))
    });

    let radius = KEEP_OUT * site.settings.clearance;
    let parked: Vec<Disc> =
        scene.others(leader).into_iter().map(|center| Disc { center, radius }).collect();
    criterion.bench_function("detour", |bencher| {
        bencher.iter(|| site.free_space.detour(black_box(from), goal, &parked))
    });

    let problem = scene.motion_problem();
    let others = scene.others(leader);
    criterion.bench_function("cell", |bencher| {
        bencher.iter(|| {
            let mut cell = voronoi_half_planes(from, black_box(&others), site.settings.clearance);
            let step = site.settings.step_radius;
            cell.extend(convex_region(&site.free_space, from, problem.waypoint, step));
            cell
        })
    });
    criterion.bench_function("motion_exact", |bencher| {
        bencher.iter(|| black_box(&problem).solve_exact())
    });
    criterion.bench_function("motion_conic", |bencher| {
        bencher.iter(|| black_box(&problem).solve_conic())
    });

    let flows = scene.held_flows();
    criterion.bench_function("certified_acceptance", |bencher| {
        bencher.iter(|| {
            let loads = black_box(&flows)
                .iter()
                .map(|(own, receivers)| worst_load(*own, receivers, &site.link));
            loads.fold(0.0, f64::max)
        })
    });
}

/// What the robots tell each other; one round of all of them.
fn coordination(criterion: &mut Criterion) {
    let scene = Scene::of_study_1();
    let mut crowd = Crowd::new(&scene);
    (0..ROUNDS_UNTIL_SETTLED).for_each(|_| crowd.exchange_beacons());
    criterion.bench_function("beacon_round_with_news", |bencher| {
        bencher.iter(|| {
            crowd.begin_period();
            crowd.exchange_beacons();
        })
    });
    criterion.bench_function("beacon_round_without_news", |bencher| {
        bencher.iter(|| crowd.exchange_beacons())
    });

    let audiences = scene.audiences();
    let views: Vec<Election> = (0..scene.site.robots)
        .map(|robot| {
            let mut view = Election::new(NoticeId::new(1, 0));
            view.place(robot, Some(Bid { rank: 1, merit: robot as i64, economy: 0 }));
            view
        })
        .collect();
    criterion.bench_function("election_round", |bencher| {
        bencher.iter(|| {
            let mut next = black_box(&views).clone();
            for (own, heard) in next.iter_mut().zip(&audiences) {
                heard.iter().for_each(|&sender| own.merge(&views[sender]));
            }
            next
        })
    });
}

criterion_group! {
    name = benches;
    config = pleach_benches::quick();
    targets = communication, motion, coordination
}
criterion_main!(benches);
