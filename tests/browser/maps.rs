//! The page of `pleach import --look`.

use super::chromium::Page;
use super::missions::kept;
use pleach::import::{self, Choices, Reading};
use pleach::scenario_file;
use std::path::Path;
use std::process::Command;

/// The page of a map of the tests, with what the command line that makes it says.
fn open(map: &str, options: &[&str]) -> Page {
    let file = kept(&map.replace('.', "-"), "");
    let output = Command::new(env!("CARGO_BIN_EXE_pleach"))
        .args(["import", &format!("tests/maps/{map}"), "--look", file.to_str().unwrap()])
        .args(options)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Page::open(&file, [1360, 900])
}

/// Clicks on a place of the scenario.
fn click(page: &mut Page, [x, y]: [f64; 2]) {
    let place = page.value(&format!(
        "(() => {{ const svg = document.getElementById('plan'), box = svg.getBoundingClientRect();
           const point = new DOMPoint({x}, {}).matrixTransform(svg.getScreenCTM());
           return [point.x - box.left, point.y - box.top]; }})()",
        -y
    ));
    page.click("#plan", Some(serde_json::from_value(place).unwrap()));
}

fn command(page: &mut Page) -> String {
    page.value("document.getElementById('command').textContent").as_str().unwrap().to_owned()
}

fn assert_content(page: &Page) {
    assert!(page.complaints.is_empty(), "{:?}", page.complaints);
}

/// Clicks become a command, which makes the scenario that was seen.
#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn places_are_set_by_clicking() {
    let mut page = open("cellar.map", &["--name", "vault"]);
    let before = command(&mut page);
    assert_eq!(before, "pleach import tests/maps/cellar.map --name vault --robots 8");
    click(&mut page, [3.0, 3.0]);
    page.click("[value=task]", None);
    click(&mut page, [30.0, 20.0]);
    click(&mut page, [5.0, 20.0]);
    page.click("[value=near]", None);
    click(&mut page, [6.0, 3.0]);
    page.photograph("look-cellar");
    let told = command(&mut page);
    let words: Vec<&str> = told.split(' ').collect();
    assert_eq!(words[0], "pleach");
    let output = Command::new(env!("CARGO_BIN_EXE_pleach")).args(&words[1..]).output().unwrap();
    assert!(output.status.success(), "{told}: {}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let scenario = scenario_file::parse(&text, Path::new("vault.toml")).unwrap();
    let is_near = |[x, y]: [f64; 2], at: [f64; 2]| (x - at[0]).hypot(y - at[1]) < 0.1;
    assert!(is_near(scenario.access_point[0].position, [3.0, 3.0]), "{told}");
    assert!(is_near(scenario.task[0].position, [30.0, 20.0]), "{told}");
    assert!(is_near(scenario.task[1].position, [5.0, 20.0]), "{told}");
    assert!(is_near(scenario.robot[0].position, [6.0, 3.0]), "{told}");

    // A click on a place takes it away; walls take none.
    page.click("[value=task]", None);
    click(&mut page, [30.0, 20.0]);
    assert_eq!(command(&mut page).matches("--task").count(), 1);
    click(&mut page, [0.4, 0.4]);
    assert_eq!(command(&mut page).matches("--task").count(), 1);
    let told = page.value("document.getElementById('where').textContent");
    assert!(told.as_str().unwrap().ends_with("is a wall or outside"), "{told}");
    assert_content(&page);
}

/// Floor, narrow passages and where robots get lie over the map as it is.
#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn the_floor_lies_over_the_map() {
    for (map, options) in [
        ("willow.yaml", &["--robot-radius", "0.25"][..]),
        ("flat.yaml", &["--accept-loss", "26"]),
        ("rooms.map", &[]),
        ("office.building.yaml", &["--near", "dock", "--task", "lab"]),
        ("hall.geojson", &[]),
        ("strokes.svg", &["--accept-loss", "9"]),
    ] {
        let mut page = open(map, options);
        let drawn = page.number("document.querySelectorAll('#original *').length");
        assert!(drawn > 0.0, "{map}");
        // The floor is as large on the screen as the map: it lies where the map is.
        let apart = page.number(
            "(() => { const box = id => document.getElementById(id).getBoundingClientRect();
               const [floor, map] = [box('floor'), box('original')];
               return Math.max(map.left - floor.left, map.top - floor.top,
                 floor.right - map.right, floor.bottom - map.bottom); })()",
        );
        assert!(apart < 1.0, "{map}: {apart}");
        page.photograph(&format!("look-{}", map.replace('.', "-")));
        page.prefer("color-scheme", "dark");
        page.photograph(&format!("look-{}-dark", map.replace('.', "-")));
        assert_content(&page);
    }
}

/// What a map names cannot end the data of the page.
#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn names_of_points_are_no_markup() {
    let map = Path::new("tests/maps/office.building.yaml");
    let mut plan = import::read(map, &Reading::default()).unwrap();
    plan.places.named[0].0 = "</script><script>throw 'it runs'</script>".into();
    let choices = Choices::named("office");
    let (scenario, notes) = import::skeleton(&plan, &choices).unwrap();
    let text = import::page(&plan, &scenario, &choices, &notes, "pleach import 'a & <b>'");
    let mut page = Page::open(&kept("markup", &text), [1360, 900]);
    assert_eq!(command(&mut page), "pleach import 'a & <b>' --robots 8");
    assert_content(&page);
}
