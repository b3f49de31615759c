//! Maps as their publishers ship them: each is right, or refused with a sentence that helps.

use super::{Dice, plan};
use pleach::import::{self, Choices, Plan, Reading, SkeletonError, Spot};
use std::path::Path;

fn floor(plan: &Plan) -> f64 {
    super::shapes::area(&plan.workspace.boundary)
        - plan.workspace.holes.iter().map(super::shapes::area).sum::<f64>()
}

fn refused(map: &Path, reading: &Reading) -> String {
    import::read(map, reading).unwrap_err().to_string()
}

/// A map of features in a file of the tests.
fn features(name: &str, features: &[&str]) -> std::path::PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let map = format!(r#"{{"type": "FeatureCollection", "features": [{}]}}"#, features.join(", "));
    std::fs::write(&path, map).unwrap();
    path
}

fn feature(properties: &str, kind: &str, coordinates: &str) -> String {
    format!(
        r#"{{"type": "Feature", "properties": {{{properties}}}, "geometry": {{"type": "{kind}", "coordinates": {coordinates}}}}}"#
    )
}

#[test]
fn rooms_with_doors_one_cell_wide_stay_whole() {
    let plan = plan("rooms.map", &Reading::default());
    assert_eq!(plan.notes[0], "808 of 808 free cells become floor: 0 % lost");
    assert_eq!(floor(&plan), 808.0);
}

/// The default clearance of this map is 0.1625; robots with twice the half width of the doors pass none.
#[test]
fn a_default_that_cuts_the_floor_is_refused_with_a_number_that_fits() {
    let map = Path::new(env!("CARGO_TARGET_TMPDIR")).join("slits.geojson");
    let hall = feature("", "Polygon", "[[[0, 0], [60, 0], [60, 20], [0, 20]]]");
    let wall = |low: f64, high: f64| {
        feature(
            r#""type": "wall""#,
            "Polygon",
            &format!("[[[30, {low}], [31, {low}], [31, {high}], [30, {high}]]]"),
        )
    };
    features("slits.geojson", &[&hall, &wall(0.0, 9.8), &wall(10.2, 20.0)]);
    let plan = import::read(&map, &Reading { planar: true, ..Reading::default() }).unwrap();
    let error = import::skeleton(&plan, &Choices::named("slits")).unwrap_err();
    let SkeletonError::TooLarge { clearance, reached, fitting } = error else { panic!("{error}") };
    assert_eq!(clearance, 0.25);
    assert!((0.4..0.6).contains(&reached), "{reached}");
    let fitting = fitting.unwrap();
    assert!((0.18..0.2).contains(&fitting), "{fitting}");
    let choices = Choices { clearance: Some(fitting), ..Choices::named("slits") };
    import::skeleton(&plan, &choices).unwrap();
}

#[test]
fn walls_are_walls_by_whatever_property_says_so() {
    let planar = Reading { planar: true, ..Reading::default() };
    for (map, area) in [
        ("wall-type.geojson", 196.0),
        ("wall-indoor.geojson", 196.0),
        ("wall-line.geojson", 200.0 - 0.6),
    ] {
        let plan = plan(map, &Reading::default());
        assert!((floor(&plan) - area).abs() < 1e-3, "{map}: {}", floor(&plan));
        assert_eq!(plan.workspace, self::plan(map, &planar).workspace, "lengths are recognised");
    }
    let wide = Reading { wall_width: Some(0.5), ..Reading::default() };
    assert!((floor(&plan("wall-line.geojson", &wide)) - 197.0).abs() < 1e-3);
}

#[test]
fn a_wall_on_the_outline_up_to_noise_stays_valid() {
    let plan = plan("noise-on-a-side.geojson", &Reading::default());
    assert!((floor(&plan) - (25.0 * 12.0 - 3.0 * 0.4)).abs() < 1e-3, "{}", floor(&plan));
    import::skeleton(&plan, &Choices::named("noise")).unwrap();
}

/// A corner of the drawing is closed off, and its loss is no accident.
#[test]
fn strokes_are_walls() {
    let error = refused(Path::new("tests/maps/strokes.svg"), &Reading::default());
    let said = "18704 of 20540 square units become floor: 8.9 % lost (8.9 % in separate pieces of floor); \
                give --accept-loss 9 if that is right";
    assert!(error.ends_with(said), "{error}");
    let plan = plan("strokes.svg", &Reading { accepted_loss: 0.09, ..Reading::default() });
    let said = "3 lines that are not closed are walls, as wide as drawn (--wall-width)";
    assert_eq!(plan.notes[1], said);
    // Two walls of 45 and one of 90, 2 wide; the fourth line is a point.
    assert!(
        (plan.account.stated - (190.0 * 110.0 - 2.0 * 180.0)).abs() < 2.5,
        "{:?}",
        plan.account
    );
}

#[test]
fn a_building_of_open_rmf_is_what_its_walls_enclose() {
    let plan = plan("office.building.yaml", &Reading::default());
    let area = 11.9 * 7.9 - 0.1 * (2.95 + 2.95);
    assert!((floor(&plan) - area).abs() < 1e-3, "{}", floor(&plan));
    let spot = |name: &str| Spot::Named(name.into());
    let choices = Choices {
        near: Some(spot("dock")),
        tasks: vec![spot("lab")],
        robots: 4,
        ..Choices::named("office")
    };
    let (scenario, _) = import::skeleton(&plan, &choices).unwrap();
    assert_eq!(scenario.access_point[0].position, [8.0, -9.0]);
    assert_eq!(scenario.task[0].position, [15.0, -9.0]);
    let choices = Choices { tasks: vec![spot("bay")], ..choices };
    let error = import::skeleton(&plan, &choices).unwrap_err().to_string();
    assert_eq!(error, r#"no point of the map is named "bay": named are dock, lab"#);
}

#[test]
fn one_level_of_several_must_be_chosen() {
    let square = |x: u32| format!("[[[{x}, 0], [{}, 0], [{}, 9], [{x}, 9]]]", x + 9, x + 9);
    let rooms = [("0", 0), ("1", 20), ("1", 29), ("0;1", 9)];
    let rooms = rooms.map(|(level, x)| {
        feature(&format!(r#""indoor": "corridor", "level": "{level}""#), "Polygon", &square(x))
    });
    let map = features("levels.geojson", &rooms.each_ref().map(String::as_str));
    let planar = Reading { planar: true, ..Reading::default() };
    assert!(
        refused(&map, &planar).contains("the map has the levels 0, 1: choose one with --level")
    );
    let level = |level: &str| Reading { level: Some(level.into()), ..planar.clone() };
    assert!(refused(&map, &level("2")).contains("the map has no level 2: it has 0, 1"));
    let ground = import::read(&map, &level("0")).unwrap();
    assert_eq!(floor(&ground), 162.0);
    let upper = Reading { accepted_loss: 0.5, ..level("1") };
    assert_eq!(floor(&import::read(&map, &upper).unwrap()), 162.0);
    let error = refused(&map, &level("1"));
    assert!(error.contains("--accept-loss 33.4"), "{error}");
}

/// Two rooms of OpenStreetMap's indoor tagging share a wall with a door in it.
#[test]
fn rooms_have_walls_with_doors() {
    let room = |x: u32| {
        feature(
            r#""indoor": "room", "level": 0"#,
            "Polygon",
            &format!("[[[{x}, 0], [{}, 0], [{}, 6], [{x}, 6]]]", x + 5, x + 5),
        )
    };
    let door = feature(r#""door": "hinged", "width": "0.9", "level": "0""#, "Point", "[5, 3]");
    let planar = Reading { planar: true, ..Reading::default() };
    let map = features("rooms.geojson", &[&room(0), &room(5), &door]);
    let plan = import::read(&map, &planar).unwrap();
    assert_eq!(plan.account.in_pieces, 0.0, "{:?}", plan.account);
    let area = 2.0 * 4.9 * 5.9 + 0.1 * 0.9;
    assert!((floor(&plan) - area).abs() < 1e-3, "{} of {area}", floor(&plan));
    let without = features("rooms.geojson", &[&room(0), &room(5)]);
    let plan = import::read(&without, &planar).unwrap();
    assert_eq!(floor(&plan), 60.0);
    assert!(plan.notes.iter().any(|note| note.starts_with("no doors are on this map")));
}

#[test]
fn what_is_not_recognised_is_named_and_can_be_said() {
    let hall = feature(r#""kind": "floor""#, "Polygon", "[[[0, 0], [9, 0], [9, 9], [0, 9]]]");
    let table = feature(r#""kind": "table""#, "Polygon", "[[[2, 2], [4, 2], [4, 4], [2, 4]]]");
    let map = features("kinds.geojson", &[&hall, &table]);
    let planar = Reading { planar: true, ..Reading::default() };
    let plan = import::read(&map, &planar).unwrap();
    assert_eq!(floor(&plan), 81.0);
    assert!(
        plan.notes.contains(
            &"polygons with kind=table: 1 taken as floor (--wall kind=table: walls)".into()
        ),
        "{:?}",
        plan.notes
    );
    let said = Reading { walls: vec![("kind".into(), "table".into())], ..planar };
    assert_eq!(floor(&import::read(&map, &said).unwrap()), 77.0);
    let mistyped = Reading { walls: vec![("kind".into(), "tables".into())], ..said };
    assert!(refused(&map, &mistyped).contains("--wall kind=tables: no feature of the map has"));
}

#[test]
fn an_image_alone_needs_the_side_of_a_pixel() {
    let path = Path::new("tests/maps/flat.pgm");
    let error = refused(path, &Reading::default());
    assert!(error.contains("give --resolution LENGTH, the side of a pixel"), "{error}");
    let reading = Reading { resolution: Some(0.05), ..super::of_the_flat() };
    let plan = import::read(path, &reading).unwrap();
    let with_keys = self::plan("flat.yaml", &super::of_the_flat());
    assert!((floor(&plan) - floor(&with_keys)).abs() < 1e-6);
}

#[test]
fn what_would_have_no_effect_is_refused() {
    let property = || vec![("kind".into(), "table".into())];
    let none = Reading::default;
    let refuses = |map: &str, reading: Reading, option: &str| {
        let error = refused(&Path::new("tests/maps").join(map), &reading);
        assert!(error.contains(&format!("{option} is for ")), "{map}: {error}");
    };
    refuses("flat.yaml", Reading { resolution: Some(0.05), ..none() }, "--resolution");
    refuses("flat.yaml", Reading { planar: true, ..none() }, "--planar");
    refuses("flat.yaml", Reading { level: Some("0".into()), ..none() }, "--level");
    refuses("flat.pgm", Reading { walls: property(), ..none() }, "--wall");
    refuses("flat.pgm", Reading { floors: property(), ..none() }, "--floor");
    refuses("flat.pgm", Reading { wall_width: Some(0.2), ..none() }, "--wall-width");
    let hall = feature(r#""kind": "floor""#, "Polygon", "[[[0, 0], [9, 0], [9, 9], [0, 9]]]");
    let map = features("hall.geojson", &[&hall]);
    let error = refused(&map, &Reading { specks: Some(3), ..none() });
    assert!(error.contains("--specks is for maps of cells: leave it out for this map"), "{error}");
}

/// Specks as mapping programs leave them: single cells, some of them side by side.
#[test]
fn specks_are_dropped_and_told() {
    let (width, height) = (120, 80);
    let mut pixels = vec![254_u8; width * height];
    let mut dice = Dice::new(7);
    for (at, pixel) in pixels.iter_mut().enumerate() {
        let (column, row) = (at % width, at / width);
        if column == 0
            || row == 0
            || column == width - 1
            || row == height - 1
            || dice.below(500) == 0
        {
            *pixel = 0;
        }
    }
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("specks.pgm");
    std::fs::write(&path, [format!("P5 {width} {height} 255\n").as_bytes(), &pixels].concat())
        .unwrap();
    let reading = Reading { resolution: Some(0.05), ..Reading::default() };
    let plan = import::read(&path, &reading).unwrap();
    assert!(plan.workspace.holes.is_empty(), "{:?}", plan.workspace.holes);
    assert!(
        plan.notes.iter().any(|note| note.contains("--specks 0 keeps them")),
        "{:?}",
        plan.notes
    );
    let kept = import::read(&path, &Reading { specks: Some(0), ..reading }).unwrap();
    assert!(kept.workspace.holes.len() > 5);
}

/// The hall of a station with a shop: ways and nodes as an editor of OpenStreetMap saves them.
#[test]
fn an_indoor_map_of_openstreetmap_is_read() {
    let plan = plan("station.osm", &Reading { level: Some("0".into()), ..Reading::default() });
    // 0.0002 degrees by 0.0001 degrees at the equator, without the walls of the shop.
    let degree = 111_195.08;
    let hall = (2e-4 * degree) * (1e-4 * degree);
    let shop = (5e-5 * degree) * 4.0 * 0.1;
    assert!(
        (floor(&plan) - (hall - shop + 0.1)).abs() < 0.3,
        "{} of {}",
        floor(&plan),
        hall - shop
    );
    assert_eq!(plan.account.in_pieces, 0.0);
    assert_eq!(plan.places.named[0].0, "information");
}
