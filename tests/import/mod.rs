//! Maps of other programs become scenarios, and no robot gets through their walls.

mod as_published;
mod random_grids;
mod random_plans;
mod shapes;

use shapes::Dice;

use pleach::automaton::network::record::Outcome;
use pleach::continuous::Point;
use pleach::import::{self, Choices, Plan, Radio, Reading, SkeletonError, Spot};
use pleach::mission;
use pleach::scenario_file;
use std::path::Path;

fn plan(map: &str, reading: &Reading) -> Plan {
    import::read(&Path::new("tests/maps").join(map), reading).unwrap_or_else(|e| panic!("{e}"))
}

/// As the flat is read: a quarter of what is free lies outside of it.
fn of_the_flat() -> Reading {
    Reading { accepted_loss: 0.26, ..Reading::default() }
}

fn corners(plan: &Plan) -> usize {
    let rings = std::iter::once(&plan.workspace.boundary).chain(&plan.workspace.holes);
    rings.map(Vec::len).sum()
}

/// The image of the flat, read by this test itself: rows from the top.
fn pixels() -> (usize, usize, Vec<u8>) {
    let bytes = std::fs::read("tests/maps/flat.pgm").unwrap();
    let header = b"P5\n# drawn for the tests of pleach\n180 110\n255\n";
    (180, 110, bytes.strip_prefix(header).unwrap().to_vec())
}

#[test]
fn a_map_of_the_map_server_is_traced_without_a_wall_inside() {
    let (width, height, pixels) = pixels();
    for tolerance in [0.0, 0.05, 0.1] {
        let reading = Reading { tolerance: Some(tolerance), specks: Some(0), ..of_the_flat() };
        let plan = plan("flat.yaml", &reading);
        let ring = |ring: &Vec<[f64; 2]>| ring.iter().map(|&corner| Point::from(corner)).collect();
        let workspace = pleach::continuous::geometry::Workspace::new(
            ring(&plan.workspace.boundary),
            plan.workspace.holes.iter().map(ring).collect(),
        )
        .unwrap();
        assert_eq!(plan.workspace.holes.len(), 3, "oblique wall, pillar, cupboard: {tolerance}");
        for (index, _) in pixels.iter().enumerate().filter(|(_, shade)| **shade < 250) {
            let (column, row) = ((index % width) as f64, (height - 1 - index / width) as f64);
            for [x, y] in [[0.5, 0.5], [0.02, 0.02], [0.98, 0.02], [0.02, 0.98], [0.98, 0.98]] {
                let place = Point::new(-2.0 + 0.05 * (column + x), -1.0 + 0.05 * (row + y));
                assert!(!workspace.contains(place), "a wall at {place} is floor: {tolerance}");
            }
        }
    }
    let [exact, simple] = [0.0, 0.05].map(|tolerance| {
        corners(&plan("flat.yaml", &Reading { tolerance: Some(tolerance), ..of_the_flat() }))
    });
    assert!(simple * 2 < exact, "{simple} of {exact} corners");
}

/// How many cells are free of a map of the map server, of whose 12 by 12 pixels those in the right half are as given
/// and the others white.
fn free_cells(name: &str, image_header: &str, pixel: &[u8], keys: &str) -> Result<String, String> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let [image, map] = ["pnm", "yaml"].map(|ending| folder.join(name).with_extension(ending));
    let white = vec![255; pixel.len()];
    let row = [white.repeat(6), pixel.repeat(6)].concat();
    std::fs::write(&image, [image_header.as_bytes(), &row.repeat(12)].concat()).unwrap();
    std::fs::write(&map, format!("image: {name}.pnm\nresolution: 1\n{keys}")).unwrap();
    let reading = Reading { tolerance: Some(0.0), ..Reading::default() };
    let plan = import::read(&map, &reading).map_err(|error| error.to_string())?;
    Ok(plan.notes[0].clone())
}

const GREY: &str = "P5 12 12 255\n";
const COLOURS: &str = "P6 12 12 255\n";
const TRANSPARENT: &str =
    "P7\nWIDTH 12\nHEIGHT 12\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n";

/// Channels are averaged, alpha among them in the mode trinary; what is occupied is decided before what is free.
#[test]
fn pixels_are_free_where_the_map_server_says_so() {
    let [all, half] = [
        "144 of 144 free cells become floor: 0 % lost",
        "72 of 72 free cells become floor: 0 % lost",
    ];
    for (image_header, pixel, keys, expected) in [
        (GREY, &[206][..], "", all), // an occupancy of 0.192
        (GREY, &[205], "", half),    // of 0.196078
        (GREY, &[217], "occupied_thresh: 0.1\n", half),
        (GREY, &[217], "free_thresh: 0.1\n", half),
        (COLOURS, &[255, 255, 110], "", all),
        (COLOURS, &[255, 255, 0], "", half),
        (TRANSPARENT, &[255, 255, 255, 0], "", half),
        (TRANSPARENT, &[255, 255, 255, 60], "", all),
        (TRANSPARENT, &[255, 255, 255, 254], "mode: scale\n", half),
    ] {
        let free = free_cells("pixels", image_header, pixel, keys);
        assert_eq!(free.as_deref(), Ok(expected), "{pixel:?} {keys}");
    }
}

#[test]
fn thresholds_that_are_no_occupancy_are_refused() {
    for (keys, said) in [
        ("free_thresh: 25\n", "free_thresh is 25: it must be from 0 to 1"),
        ("occupied_thresh: -0.65\n", "occupied_thresh is -0.65: it must be from 0 to 1"),
        ("mode: raw\n", "mode: raw maps are not read; trinary and scale are"),
        ("mode: grey\n", "mode: grey maps are not read; trinary and scale are"),
    ] {
        let error = free_cells("thresholds", GREY, &[0], keys).unwrap_err();
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn an_imported_flat_is_serviced() {
    let plan = plan("flat.yaml", &of_the_flat());
    let choices = Choices { robots: 12, clearance: Some(0.05), ..Choices::named("flat") };
    let (scenario, notes) = import::skeleton(&plan, &choices).unwrap();
    let text = import::text(&scenario, "flat.yaml", &notes);
    let again = scenario_file::parse(&text, Path::new("flat.toml")).unwrap();
    assert_eq!(again.workspace, scenario.workspace);
    assert_eq!(again.robot, scenario.robot);
    let end = mission::run(&again, &mut []).unwrap().end;
    assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
}

/// A robot mapped this building: oblique corridors, clutter, doors. Its mission: `cargo test -p missions`.
#[test]
fn a_real_building_is_imported() {
    let plan = plan("willow.yaml", &Reading::default());
    assert!(plan.notes[1].contains("566 by 608 cells"), "{:?}", plan.notes);
    let choices = Choices { robots: 12, clearance: Some(0.25), ..Choices::named("willow") };
    let (scenario, notes) = import::skeleton(&plan, &choices).unwrap();
    assert!(scenario.workspace.holes.len() > 100, "pillars, tables and chairs");
    let passages = notes.iter().filter(|note| note.starts_with("the passage at")).count();
    assert_eq!(passages, 8, "{notes:?}");
    assert!(notes.iter().any(|note| note.ends_with("more passages are narrower than these")));
}

#[test]
fn a_benchmark_map_keeps_its_walls() {
    let plan = plan("cellar.map", &Reading { tolerance: Some(0.0), ..Reading::default() });
    assert_eq!(plan.workspace.holes.len(), 2);
    assert!(plan.notes[1].contains("40 by 24 cells"), "{:?}", plan.notes);
    assert!(
        plan.workspace.boundary.contains(&[1.0, 1.0])
            && plan.workspace.boundary.contains(&[39.0, 23.0])
    );
}

/// A hall of 30 m by 20 m and an annexe of 10 m by 8 m share a wall with an opening.
#[test]
fn degrees_become_metres_and_touching_polygons_one_floor() {
    let plan = plan("hall.geojson", &Reading::default());
    let area = |ring: &Vec<[f64; 2]>| {
        let sides = ring.iter().zip(ring.iter().cycle().skip(1));
        (sides.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>() / 2.0).abs()
    };
    let floor = area(&plan.workspace.boundary) - plan.workspace.holes.iter().map(area).sum::<f64>();
    let walls = 0.2 * 2.1 + 0.2 * 2.0; // in the hall, and in the annexe
    assert!((floor - (600.0 - 24.0 + 80.0 - walls)).abs() < 0.5, "{floor}");
    let (scenario, _) = import::skeleton(&plan, &Choices::named("hall")).unwrap();
    let digits = format!("{:?}", scenario.task[0].position);
    assert!(digits.len() < 24, "places have as many digits as the outline: {digits}");
    assert_eq!((scenario.access_point.len(), scenario.task.len()), (1, 1));
    let planar = Reading { planar: true, ..Reading::default() };
    assert!(corners(&self::plan("hall.geojson", &planar)) == corners(&plan));
}

#[test]
fn shapes_of_a_drawing_bound_the_floor() {
    let reading = Reading { scale: 0.01, tolerance: Some(0.002), ..Reading::default() };
    let plan = plan("gallery.svg", &reading);
    assert_eq!(plan.workspace.holes.len(), 3);
    assert!(
        plan.notes[1].starts_with("chords of curves are at most 0.002 away"),
        "{:?}",
        plan.notes
    );
    let highest = plan.workspace.boundary.iter().map(|corner| corner[1]).fold(0.0, f64::max);
    assert!((highest - 2.0).abs() < 1e-6, "the vertical axis points up");
    let bevel = plan.workspace.boundary.iter().filter(|corner| corner[0] > 2.4 && corner[1] > 1.4);
    assert!(bevel.count() > 5, "the rounded corner is at the top right");
}

/// A room of 40 by 20, and what else is drawn.
fn room_with(name: &str, drawn: &str) -> Result<Plan, String> {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let room = "<path d='M0,0 H40 V20 H0 Z'/>";
    std::fs::write(&path, format!("<svg>{room}{drawn}</svg>")).unwrap();
    import::read(&path, &Reading::default()).map_err(|error| error.to_string())
}

/// Only closed shapes that are seen bound the floor; other lines are told.
#[test]
fn of_a_drawing_only_closed_shapes_are_taken() {
    let read = |name: &str, drawn: &str| room_with(name, drawn).unwrap();
    let alone = read("room.svg", "");
    assert_eq!(corners(&alone), 4);
    assert_eq!(alone.notes, ["800 of 800 square units become floor: 0 % lost"]);
    for unseen in [
        "<defs><rect width='400' height='400'/></defs>",
        "<clipPath><circle r='9'/></clipPath>",
        "<g display='none'><rect x='3' y='3' width='4' height='4'/></g>",
        "<rect x='3' y='3' width='4' height='4' style='fill: red; display: none'/>",
        "<symbol id='a' viewBox='0 0 9 9'><rect width='9' height='9'/></symbol>",
        "<g visibility='hidden'><rect x='3' y='3' width='4' height='4'/></g>",
        "<rect x='3' y='3' width='4' height='4' style='visibility: collapse'/>",
    ] {
        assert_eq!(read("unseen.svg", unseen), alone, "{unseen}");
    }
    let lines = "<path d='M5,5 H9 V9'/><line x1='1' y1='1' x2='9' y2='1'/>\
                 <polyline points='12,12 15,12 15,15'/>";
    let drawn = read("lines.svg", lines);
    assert_eq!(drawn.workspace, alone.workspace);
    let said =
        "left out: 3 lines that are not closed and not drawn: --wall-width takes them as walls";
    assert_eq!(drawn.notes[1..], [said]);
    let pillar = "<polyline points='12,12 15,12 15,15 12,12'/>";
    assert_eq!(read("pillar.svg", pillar).workspace.holes.len(), 1);
}

/// One pillar of 4 by 4, drawn in many ways.
#[test]
fn shapes_stand_where_the_drawing_shows_them() {
    let pillar = room_with("shown.svg", "<rect x='10' y='5' width='4' height='4'/>").unwrap();
    assert_eq!(pillar.workspace.holes.len(), 1);
    for drawn in [
        "<defs><rect id='a' width='4' height='4'/></defs><use href='#a' x='10' y='5'/>",
        "<use xlink:href='#a' x='10' transform='translate(0 5)'/>\
         <defs><g transform='scale(5)'><rect id='a' transform='scale(2)' width='2' height='2'/></g></defs>",
        "<symbol id='a' viewBox='0 0 1 1'><rect width='1' height='1'/></symbol>\
         <use href='#a' x='10' y='5' width='4' height='4'/>",
        "<defs><use id='b' href='#a' y='5'/><rect id='a' width='4' height='4'/></defs>\
         <use href='#b' x='10'/>",
        "<svg x='10' y='5'><rect width='4' height='4'/></svg>",
        "<svg x='10' y='5' width='4' height='4' viewBox='100 100 2 2'>\
         <rect x='100' y='100' width='2' height='2'/></svg>",
        "<svg x='8' y='5' width='8' height='4' viewBox='0 0 2 2'><rect width='2' height='2'/></svg>",
        "<svg x='8' y='3' width='2' height='4' viewBox='0 0 2 2' preserveAspectRatio='xMinYMax slice'>\
         <rect x='1' y='1' width='2' height='2'/></svg>",
        "<svg x='10' y='5' width='8' height='4' viewBox='0 0 2 2' preserveAspectRatio='none'>\
         <rect width='1' height='2'/></svg>",
        "<g visibility='hidden'>\
         <rect x='10' y='5' width='4' height='4' visibility='visible'/></g>",
        "<rect display='none' style='display: inline' x='10' y='5' width='4' height='4'/>",
    ] {
        assert_eq!(room_with("shown.svg", drawn).as_ref(), Ok(&pillar), "{drawn}");
    }
}

/// Corners of rectangles are walls where they are rounded.
#[test]
fn rounded_rectangles_lose_their_corners() {
    let area_of_hole = |radii: &str| {
        let drawn = format!("<rect x='10' y='5' width='8' height='4' {radii}/>");
        let hole = &room_with("rounded.svg", &drawn).unwrap().workspace.holes[0];
        let sides = hole.iter().zip(hole.iter().cycle().skip(1));
        (sides.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>() / 2.0).abs()
    };
    let corners = 4.0 - std::f64::consts::PI; // of a circle of radius 1
    for (radii, lost) in [
        ("rx='0' ry='2'", 0.0),
        ("rx='1'", corners),
        ("ry='1'", corners),
        ("rx='auto' ry='1'", corners),
        ("rx='2' ry='1'", 2.0 * corners),
        ("rx='100' ry='100'", 8.0 * corners),
    ] {
        let area = area_of_hole(radii);
        assert!((area - (32.0 - lost)).abs() < 0.3, "{radii}: {area}");
    }
}

/// What is drawn and not read is told.
#[test]
fn nothing_that_is_drawn_vanishes_silently() {
    let use_of = |what: &str| format!("<use href='{what}'/>");
    let doubling: String = (0..25)
        .map(|level| format!("<g id='g{level}'>{0}{0}</g>", use_of(&format!("#g{}", level + 1))))
        .collect();
    for (drawn, said) in [
        (use_of("#none"), "byte 34: use of \"#none\": no element has this id"),
        (use_of("other.svg#a"), "only elements of the same drawing, as #name, are read"),
        ("<use/>".into(), "use has no href"),
        (format!("<g id='a'>{}</g>", use_of("#a")), "use draws itself"),
        (
            format!("<defs>{doubling}<g id='g25'/></defs>{}", use_of("#g0")),
            "more than 1000000 elements",
        ),
        ("<svg width='100%' height='9' viewBox='0 0 1 1'/>".into(), "width of svg is \"100%\""),
        ("<rect width='-4' height='4'/>".into(), "width of rect is -4: at least 0 is possible"),
        ("<circle r='-4'/>".into(), "r of circle is -4: at least 0 is possible"),
        ("</svg><svg>".into(), "the file goes on after its drawing has ended"),
    ] {
        let error = room_with("refused.svg", &drawn).unwrap_err();
        assert!(error.contains(said), "{error}");
    }
    for (drawn, said) in [
        (
            "<text>hall</text><g><image/><text/></g>",
            "left out: 3 elements that are no shape (image, text)",
        ),
        (
            "<g clip-path='url(#a)'><rect x='1' y='1' width='1' height='1'/></g>",
            "clip paths and masks are not read: 1 element is taken whole",
        ),
        ("<style>.a { display: none }</style>", "style sheets are not read"),
    ] {
        let notes = room_with("noted.svg", drawn).unwrap().notes;
        assert!(notes.len() == 2 && notes[1].starts_with(said), "{notes:?}");
    }
}

/// What would take for ever, or make no sense, is refused.
#[test]
fn lengths_that_are_none_are_refused() {
    let plan = plan("cellar.map", &Reading::default());
    let named = || Choices::named("cellar");
    for (choices, said) in [
        (Choices { clearance: Some(0.0), ..named() }, "the clearance is 0: it must be"),
        (Choices { full_range: Some(-1.0), ..named() }, "the full range is -1: it must be"),
        (Choices { max_range: Some(f64::NAN), ..named() }, "the maximal range is NaN: it must be"),
    ] {
        let error = import::skeleton(&plan, &choices).unwrap_err().to_string();
        assert!(error.starts_with(said), "{error}");
    }
    let huge = Reading { scale: 1e200, ..of_the_flat() };
    let error = import::skeleton(&self::plan("flat.yaml", &huge), &named()).unwrap_err();
    assert!(error.to_string().contains("at most 1e100"), "{error}");
    let fine = Reading { tolerance: Some(1e-12), ..Reading::default() };
    let error = import::read(Path::new("tests/maps/gallery.svg"), &fine).unwrap_err().to_string();
    assert!(
        error.contains("the tolerance of curves is 0.000000000001: at least 0.0003"),
        "{error}"
    );
}

/// As in a survey, whose coordinates are metres from far away.
#[test]
fn floors_far_from_the_origin_are_moved_there() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("survey.geojson");
    let [west, south] = [500_000.25, 4_649_776.5];
    let [east, north] = [west + 40.0, south + 20.0];
    let floor = format!(
        r#"{{"type": "Polygon", "coordinates":
            [[[{west}, {south}], [{east}, {south}], [{east}, {north}], [{west}, {north}], [{west}, {south}]]]}}"#
    );
    let feature = |kind: &str, geometry: &str| {
        format!(
            r#"{{"type": "Feature", "properties": {{"kind": "{kind}"}}, "geometry": {geometry}}}"#
        )
    };
    let task = format!(r#"{{"type": "Point", "coordinates": [{}, {}]}}"#, west + 30.0, south + 5.0);
    let features = [feature("floor", &floor), feature("task", &task)].join(", ");
    std::fs::write(&path, format!(r#"{{"type": "FeatureCollection", "features": [{features}]}}"#))
        .unwrap();
    let plan = import::read(&path, &Reading { planar: true, ..Reading::default() }).unwrap();
    let (scenario, _) = import::skeleton(&plan, &Choices::named("survey")).unwrap();
    assert!(scenario.workspace.boundary.contains(&[40.25, 20.5]), "{:?}", scenario.workspace);
    assert_eq!(scenario.task[0].position, [30.25, 5.5]);
    let said = "(500000, 4649776) of the map is the origin of the scenario, whose coordinates are at most 10000";
    assert_eq!(plan.notes.last().map(String::as_str), Some(said));
}

#[test]
fn as_many_tasks_are_placed_as_there_are_places() {
    let plan = plan("cellar.map", &Reading::default());
    let choices = Choices { far_tasks: 3000, ..Choices::named("cellar") };
    let (scenario, notes) = import::skeleton(&plan, &choices).unwrap();
    let mut places: Vec<_> =
        scenario.task.iter().map(|task| task.position.map(f64::to_bits)).collect();
    let count = places.len();
    assert!((100..3000).contains(&count), "{count}");
    places.sort();
    places.dedup();
    assert_eq!(places.len(), count);
    let said = format!(
        "{count} tasks are placed and not 3000: there are no more places that robots reach"
    );
    assert!(notes.contains(&said), "{notes:?}");
}

/// From every robot a chain of links that no wall crosses leads to the access point.
#[test]
fn robots_start_in_sight_of_each_other() {
    for (map, robots) in [("cellar.map", 8), ("rooms.map", 4), ("office.building.yaml", 6)] {
        let plan = plan(map, &Reading::default());
        let clearance = Some(0.1);
        let choices =
            Choices { robots, clearance, radio: Some(Radio::Wifi), ..Choices::named("sight") };
        let (scenario, _) = import::skeleton(&plan, &choices).unwrap();
        let (site, reach) = (scenario.site(), scenario.link.max_range);
        let mut ahead: Vec<Point> =
            scenario.robot.iter().map(|robot| robot.position.into()).collect();
        let mut reached = site.access_points.clone();
        while let Some(from) = reached.pop() {
            let is_linked = |to: &mut Point| {
                (*to - from).norm() < reach && site.workspace.segment_clearance(from, *to) > 0.0
            };
            reached.extend(ahead.extract_if(.., is_linked));
        }
        assert!(ahead.is_empty(), "{map}: {ahead:?} are behind walls");
    }
}

/// The number that the error names does fit, and one more does not.
#[test]
fn robots_that_do_not_fit_are_counted() {
    let plan = plan("cellar.map", &Reading::default());
    let of = |robots: usize| {
        let choices = Choices { robots, clearance: Some(1.0), ..Choices::named("cellar") };
        import::skeleton(&plan, &choices)
    };
    let error = of(5000).unwrap_err();
    let SkeletonError::TooMany { fitting, .. } = error else { panic!("{error}") };
    let said = format!(
        "5000 robots of radius 1 do not fit on the floor that they can reach: with the distance that they keep, {fitting} do"
    );
    assert!(error.to_string().starts_with(&said), "{error}");
    assert!(of(fitting + 1).is_err());
    let (scenario, notes) = of(fitting).unwrap();
    assert_eq!(scenario.robot.len(), fitting);
    assert!(notes.iter().any(|note| note.starts_with("robots start in rows")), "{notes:?}");
}

#[test]
fn a_range_that_is_the_radio_s_is_told_and_so_are_rates() {
    let plan = plan("cellar.map", &Reading::default());
    let notes = |full_range, max_range| {
        let radio = Some(Radio::Wifi);
        let choices = Choices { radio, full_range, max_range, ..Choices::named("cellar") };
        import::skeleton(&plan, &choices).unwrap().1
    };
    for (full_range, max_range, said) in [
        (Some(3.0), None, "max_range = 35 is the radio's, and full_range = 3 is not"),
        (Some(40.0), None, "max_range = 50 follows from full_range = 40, since the radio's 35 is"),
        (None, Some(30.0), "full_range = 25 is the radio's, and max_range = 30 is not"),
    ] {
        let notes = notes(full_range, max_range);
        assert!(notes.iter().any(|note| note.starts_with(said)), "{notes:?}");
    }
    for (full_range, max_range) in [(None, None), (Some(3.0), Some(4.0))] {
        let notes = notes(full_range, max_range);
        assert!(!notes.iter().any(|note| note.contains("range")), "{notes:?}");
        let rate = "rate = 0.075 for each robot, together at most 0.6 of what one robot can carry";
        assert!(notes.iter().any(|note| note.starts_with(rate)), "{notes:?}");
    }
}

#[test]
fn narrow_passages_and_closed_parts_are_told() {
    let plan = plan("cellar.map", &Reading::default());
    let choices =
        Choices { clearance: Some(3.5), full_range: Some(20.0), ..Choices::named("cellar") };
    let told = match import::skeleton(&plan, &choices) {
        Ok((_, notes)) => notes.join("\n"),
        Err(error) => error.to_string(),
    };
    assert!(told.contains("the passage at") || told.contains("do not fit"), "{told}");
}

#[test]
fn an_access_point_outside_the_floor_is_told() {
    let plan = plan("cellar.map", &Reading::default());
    let outside = Spot::At([1000.0, 3.0]);
    let choices = Choices { access_points: vec![outside], ..Choices::named("cellar") };
    let error = import::skeleton(&plan, &choices).unwrap_err().to_string();
    assert!(error.starts_with("the access point at (1000, 3) is in a wall or outside"), "{error}");
}

#[test]
fn maps_that_are_none_are_refused() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for (name, text, said) in [
        ("a.map", "type octile\nheight 2\nwidth 3\nmap\n...\n..\n", "line 6: the row has 2 cells"),
        ("b.map", "height x\n", "line 1: \"height x\" states no whole number"),
        ("c.yaml", "image: none.png\nresolution: 0.05\n", "none.png: cannot be read"),
        ("d.yaml", "resolution: 0.05\n", "image is missing"),
        ("e.geojson", "{}", "e.geojson: "),
        (
            "n.geojson",
            r#"{"type": "Feature", "properties": {"kind": "wall"}, "geometry":
                {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]}}"#,
            "no floor: the map has no polygon that is floor, and its walls enclose none",
        ),
        ("o.yaml", "image: o.pgm\nresolution: 1\norigin: [.nan, 0, 0]\n", "non-finite float"),
        ("f.svg", "<svg><path d='M0,0 Q1'/></svg>", "path: "),
        ("g.svg", "<svg></svg>", "no floor"),
        ("i.svg", "<svg><rect width='9' height='9' transform='scale(0)'/></svg>", "no floor"),
        ("j.svg", "<svg><rect width='9' height='9'/>", "it is cut off"),
        ("m.svg", "<html><svg/></html>", "byte 0: the outermost element is html, not svg"),
        ("k.svg", "<svg><rect width='1e300' height='1e300'/></svg>", "a coordinate is 1e300"),
        (
            "p.svg",
            "<svg><rect width='nan' height='9'/></svg>",
            r#"width of rect is "nan": give a number"#,
        ),
        ("q.svg", "<svg><circle r='1e999'/></svg>", r#"r of circle is "1e999": give a number"#),
        (
            "r.svg",
            "<svg><polygon points='0,0 9,0 nan,9'/></svg>",
            r#"points of polygon: "nan" is no number"#,
        ),
        ("s.svg", "<svg><polyline points='0,0 9,-inf'/></svg>", r#"points of polyline: "-inf" is"#),
        ("l.map", "type octile\nheight 1\nwidth 2\nmap\n@T\n", "no cell of the map is free"),
        ("h.txt", "", "the ending says no kind of map"),
    ] {
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        let error = import::read(&path, &Reading::default()).unwrap_err().to_string();
        assert!(error.contains(said), "{name}: {error}");
    }
}

/// What a scenario is imported from stands in comments, whatever characters are in it.
#[test]
fn comments_of_scenarios_stay_comments() {
    let plan = plan("cellar.map", &Reading::default());
    let (scenario, _) = import::skeleton(&plan, &Choices::named("cellar")).unwrap();
    let notes = ["all\nname = 3".to_owned(), "one\r\nname = 2".to_owned()];
    let text = import::text(&scenario, "a\nname = 1\u{7}.map", &notes);
    assert!(
        text.starts_with("# a\\nname = 1\\u{7}.map: all\\nname = 3.\n# - one\\r\\nname = 2\n"),
        "{text}"
    );
    let read = pleach::scenario_file::parse_with(&text, Path::new("it.toml"), &[]).unwrap();
    assert_eq!(read.name, "cellar");
}

/// A wall whose ring is left open keeps all its corners: without one of them, robots would get through.
#[test]
fn a_ring_that_is_left_open_is_closed() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("open.geojson");
    let map = |last: &str| {
        let polygon = |kind: &str, to: u32| {
            format!(
                r#"{{"type": "Feature", "properties": {{"kind": "{kind}"}}, "geometry": {{"type": "Polygon",
                    "coordinates": [[[0, 0], [{to}, 0], [{to}, {to}], [0, {to}]{last}]]}}}}"#
            )
        };
        let features = [polygon("floor", 9), polygon("wall", 4)].join(", ");
        std::fs::write(
            &path,
            format!(r#"{{"type": "FeatureCollection", "features": [{features}]}}"#),
        )
        .unwrap();
        import::read(&path, &Reading { planar: true, ..Reading::default() }).unwrap()
    };
    assert_eq!(map(""), map(", [0, 0]"));
}
