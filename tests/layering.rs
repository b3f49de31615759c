//! The layering that `docs/architecture.md` describes, read off manifests and sources.

use crate::sources::{files_below, lines_of_code, manifest, read, relative, root};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The packages that users depend on, the root package first.
const PACKAGES: [&str; 7] =
    ["", "guards", "discrete", "continuous", "drawing", "automaton", "verify"];

/// A source file: its path from the root of the workspace, and its lines of code without comments.
struct Source {
    path: String,
    lines: Vec<(usize, String)>,
}

impl Source {
    fn read(file: &Path) -> Self {
        let path = relative(file);
        let text = read(&path);
        let lines = lines_of_code(&text).map(|(number, line)| (number, line.to_owned())).collect();
        Source { path, lines }
    }

    /// Whether the file belongs to the part of its package that knows of robots.
    fn is_about_the_network(&self) -> bool {
        self.path.contains("/network/")
    }

    fn package(&self) -> &str {
        self.path.split('/').next().unwrap_or_default()
    }

    /// The lines that borrow a field of this name to change it.
    fn borrows_of(&self, field: &str) -> Vec<usize> {
        let is_name = |letter: char| letter.is_alphanumeric() || letter == '_';
        let borrows = |line: &str| {
            line.split("&mut ").skip(1).any(|borrowed| {
                let rest = borrowed.trim_start_matches(is_name);
                let rest = rest.strip_prefix('.').and_then(|rest| rest.strip_prefix(field));
                rest.is_some_and(|rest| !rest.starts_with(is_name))
            })
        };
        self.lines.iter().filter(|(_, line)| borrows(line)).map(|(number, _)| *number).collect()
    }

    /// The lines that call `current_mut`, but for the body of a `current_mut`.
    fn calls_of_current_mut(&self) -> Vec<String> {
        let pairs = self.lines.windows(2).map(|pair| (&pair[0].1, &pair[1]));
        let calls = pairs.filter(|(before, (_, line))| {
            line.contains(".current_mut()") && !before.contains("fn current_mut(&mut self)")
        });
        calls
            .map(|(_, (number, line))| format!("{}:{number}: {}", self.path, line.trim()))
            .collect()
    }

    /// The lines that contain one of `words`, as `path:line: text`.
    fn lines_with(&self, words: &[&str]) -> Vec<String> {
        let found = self.lines.iter().filter(|(_, line)| words.iter().any(|w| line.contains(w)));
        found.map(|(number, line)| format!("{}:{number}: {}", self.path, line.trim())).collect()
    }
}

/// Every product source; files that hold nothing but tests are none.
fn sources() -> Vec<Source> {
    let folders = PACKAGES.iter().map(|package| Path::new(package).join("src"));
    let mut files: Vec<_> = folders.flat_map(files_below).collect();
    let is_source = |path: &Path| path.extension().is_some_and(|extension| extension == "rs");
    let is_of_tests = |path: &Path| {
        let path = relative(path);
        path.ends_with("/tests.rs") || path.contains("/tests/")
    };
    files.retain(|path| is_source(path) && !is_of_tests(path));
    files.sort();
    assert!(files.len() > 50, "the sources are not where they are looked for");
    files.iter().map(|path| Source::read(path)).collect()
}

fn assert_none(offences: Vec<String>, rule: &str) {
    assert!(offences.is_empty(), "{rule}:\n{}", offences.join("\n"));
}

/// The `[dependencies]` table of a package.
fn dependency_table(package: &str) -> toml::Table {
    let manifest = manifest(&root().join(package));
    let dependencies = manifest.get("dependencies").and_then(toml::Value::as_table);
    dependencies.cloned().unwrap_or_default()
}

/// The names of all dependencies of a package.
fn dependencies(package: &str) -> Vec<String> {
    dependency_table(package).keys().cloned().collect()
}

fn is_optional(dependency: &toml::Value) -> bool {
    dependency.get("optional").and_then(toml::Value::as_bool) == Some(true)
}

#[test]
fn only_network_modules_know_of_the_network() {
    let offences = sources()
        .iter()
        .filter(|source| !matches!(source.package(), "src" | "verify"))
        .filter(|source| !source.is_about_the_network())
        .flat_map(|source| source.lines_with(&["network::", "network}", "network,"]))
        .collect();
    assert_none(offences, "outside a network module nothing is imported from one");
}

#[test]
fn the_layers_know_only_those_below_them() {
    let layers: [(&str, &[&str]); 6] = [
        ("guards", &[]),
        ("discrete", &[]),
        ("drawing", &[]),
        ("continuous", &["pleach-guards"]),
        ("automaton", &["pleach-guards", "pleach-discrete", "pleach-continuous", "pleach-drawing"]),
        ("verify", &["pleach-guards", "pleach-discrete", "pleach-continuous", "pleach-automaton"]),
    ];
    for (package, below) in layers {
        for dependency in dependencies(package) {
            let allowed = !dependency.starts_with("pleach") || below.contains(&&*dependency);
            assert!(allowed, "{package} depends on {dependency}");
        }
    }
}

/// What explores and tests the product is no part of it: packages that are not published appear
/// among the dependencies of tests only, and nothing turns on what drives robots by hand.
#[test]
fn users_do_not_build_what_tests_the_product() {
    let workspace = manifest(root());
    let members = workspace["workspace"]["members"].as_array().unwrap();
    let folders = members.iter().map(|member| member.as_str().unwrap());
    let unpublished: Vec<String> = folders
        .map(|folder| manifest(&root().join(folder)))
        .filter(|manifest| {
            manifest["package"].get("publish").and_then(toml::Value::as_bool) == Some(false)
        })
        .map(|manifest| manifest["package"]["name"].as_str().unwrap().to_owned())
        .collect();
    assert!(unpublished.iter().any(|name| name == "pleach-exploration"), "{unpublished:?}");
    for package in PACKAGES {
        let manifest = manifest(&root().join(package));
        assert!(manifest["package"].get("publish").is_none(), "{package:?} is published");
        assert!(manifest.get("target").is_none(), "{package:?} has dependencies for some targets");
        for (name, dependency) in dependency_table(package) {
            assert!(!unpublished.contains(&name), "{package:?} depends on {name}");
            let features = dependency.get("features").and_then(toml::Value::as_array);
            let drives_robots = |feature: &toml::Value| feature.as_str() == Some("abstraction");
            assert!(!features.is_some_and(|it| it.iter().any(drives_robots)), "{package:?}");
        }
    }
}

/// Processes need a transport with hundreds of packages. They are a workspace of their own, and their
/// nodes are those of the product: nothing of them is written again.
#[test]
fn processes_are_built_by_themselves_and_run_the_same_nodes() {
    let lock = fs::read_to_string(root().join("Cargo.lock")).unwrap();
    assert!(!lock.contains("\"zenoh"), "the transport of processes is built with the others");
    assert!(manifest(&root().join("processes")).contains_key("workspace"));
    let files = files_below(Path::new("processes/src"));
    let sources: Vec<Source> = files.iter().map(|path| Source::read(path)).collect();
    assert!(sources.len() > 8, "the sources are not where they are looked for");
    let of_nodes = ["impl Node for", "impl Medium<", "pleach_automaton::", "unsafe ", "HashMap"];
    let offences = sources.iter().flat_map(|source| source.lines_with(&of_nodes)).collect();
    assert_none(offences, "a process does input and output only");
}

#[test]
fn every_picture_is_drawn_with_one_layer() {
    for package in PACKAGES.into_iter().filter(|package| *package != "drawing") {
        assert!(!dependencies(package).contains(&"svg".to_owned()), "{package:?} draws by itself");
    }
}

/// Who models something else than robots builds neither geometry nor a solver.
#[test]
fn the_framework_stands_alone() {
    let mut tree = Command::new(env!("CARGO"));
    tree.args(["tree", "-p", "pleach", "--no-default-features", "-e", "normal", "--offline"]);
    let output = tree.args(["--prefix", "none"]).current_dir(root()).output().unwrap();
    let listed = String::from_utf8(output.stdout).unwrap();
    let packages: BTreeSet<&str> =
        listed.lines().map(|line| line.trim_end_matches(" (*)")).collect();
    let names: BTreeSet<&str> =
        packages.iter().filter_map(|package| package.split(' ').next()).collect();
    assert!(names.contains("pleach-verify") && packages.len() <= 50, "{packages:?}");
    for left_out in ["clarabel", "i_overlay", "parry2d-f64", "robust", "spade", "toml", "clap"] {
        assert!(!names.contains(left_out), "{left_out} is built with the framework");
    }
}

#[test]
fn guards_and_the_discrete_layer_need_the_standard_library_only() {
    // Guards are stored in files, and messages in packets, by those who ask for it.
    for package in ["guards", "discrete"] {
        for (name, dependency) in dependency_table(package) {
            assert!(name == "serde" && is_optional(&dependency), "{package} depends on {name}");
        }
    }
}

/// The oracle computes everything itself: it would otherwise repeat the mistakes of what it checks.
#[test]
fn the_oracle_has_only_what_a_trace_holds() {
    const HELD: [&str; 3] = [
        "use pleach::automaton::network::record::{MissionEvent, Route, Snapshot};",
        "use pleach::automaton::network::scenario::Scenario;",
        "use pleach::trace::{TraceEntry, TraceReader};",
    ];
    let oracle = Source::read(&root().join("tests/missions/src/oracle.rs"));
    let uses = oracle.lines_with(&["pleach", "crate", "super"]);
    let is_held = |line: &String| HELD.iter().any(|held| line.ends_with(held));
    assert!(uses.len() >= HELD.len(), "the oracle is not where it is looked for");
    assert_none(
        uses.into_iter().filter(|line| !is_held(line)).collect(),
        "it computes the rest itself",
    );
}

/// The tests of a package are one program, so that a file that it does not name is never run.
#[test]
fn every_file_of_tests_is_in_the_program_of_its_package() {
    for package in PACKAGES.into_iter().chain(["exploration", "tests/missions"]) {
        let folder = root().join(package).join("tests");
        let Ok(program) = fs::read_to_string(folder.join("main.rs")) else { continue };
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let is_source = path.extension().is_some_and(|extension| extension == "rs");
            let is_module = path.join("mod.rs").exists() || is_source;
            let is_named = name == "main" || program.contains(&format!("mod {name};\n"));
            assert!(is_named || !is_module, "{} is not in main.rs", path.display());
        }
    }
}

/// Where an automaton of the network stands is changed by its resets alone: what holds a location
/// with its data is private, is made where its owner is made, and is assigned to nowhere. The one
/// way to change it, `current_mut`, is called by the resets of `located.rs` and by nothing else; that of a robot
/// is that of one of its components.
#[test]
fn nothing_but_resets_changes_where_an_automaton_stands() {
    let sources = sources();
    let is_of_the_network =
        |source: &&Source| source.package() == "automaton" && source.is_about_the_network();
    let network = || sources.iter().filter(is_of_the_network);
    let holds =
        |line: &String| line.trim_start().split_once(": Current<").map(|it| it.0.to_owned());
    let fields: Vec<String> = network()
        .flat_map(|source| source.lines.iter().filter_map(|(_, line)| holds(line)))
        .collect();
    assert!(fields.len() >= 3, "the places are not where they are looked for: {fields:?}");
    assert!(fields.iter().all(|field| !field.contains("pub")), "they are private: {fields:?}");
    let changes: Vec<String> = fields
        .iter()
        .flat_map(|field| [format!(".{field} ="), format!(".{field}.clone_from(")])
        .chain(["= Current::new(", "= Robot {", "current_mut(self)"].map(str::to_owned))
        .collect();
    let changes: Vec<&str> = changes.iter().map(String::as_str).collect();
    let offences = network().flat_map(|source| source.lines_with(&changes));
    let is_change = |offence: &String| !offence.contains(" == ");
    assert_none(
        offences.filter(is_change).collect(),
        "only resets change where an automaton stands",
    );
    // It is borrowed to be changed in one place: the `current_mut` of its owner.
    for field in &fields {
        let borrowed = network().flat_map(|source| source.borrows_of(field)).count();
        assert!(borrowed <= 1, "`{field}` is borrowed to be changed in {borrowed} places");
    }
    let others = sources.iter().filter(|source| source.path != "automaton/src/located.rs");
    assert_none(
        others.flat_map(Source::calls_of_current_mut).collect(),
        "only resets, and `current_mut` itself, call `current_mut`",
    );
}

#[test]
fn there_is_no_unsafe_code() {
    let offences = sources().iter().flat_map(|s| s.lines_with(&["unsafe "])).collect();
    assert_none(offences, "unsafe code is forbidden");
}

#[test]
fn nothing_depends_on_an_order_that_changes_from_run_to_run() {
    let offences = sources().iter().flat_map(|s| s.lines_with(&["HashMap", "HashSet"])).collect();
    assert_none(offences, "hash maps iterate in random order");
}

/// Clocks measure how long a run takes; they have no influence on it.
#[test]
fn only_those_who_report_times_read_the_clock() {
    const REPORTERS: [&str; 3] =
        ["automaton/src/network/composition", "src/cli/", "src/summary.rs"];
    let offences = sources()
        .iter()
        .filter(|source| !REPORTERS.iter().any(|reporter| source.path.starts_with(reporter)))
        .flat_map(|source| source.lines_with(&["std::time", "Instant::now", "SystemTime"]))
        .collect();
    assert_none(offences, "the result of a run does not depend on the time of day");
}

/// A struct of the sources: its file, and its fields, each as `name: Type`.
struct Struct {
    path: String,
    fields: Vec<String>,
}

impl Struct {
    /// The struct of this name in one of these sources, if it has named fields.
    fn find(name: &str, sources: &[Source]) -> Option<Struct> {
        sources.iter().find_map(|source| {
            let is_head = |line: &str| {
                let names = line.split(&[' ', '<'][..]);
                line.ends_with('{')
                    && names.skip_while(|word| *word != "struct").nth(1) == Some(name)
            };
            let mut lines = source.lines.iter().map(|(_, line)| line.trim_end());
            lines.find(|line| is_head(line))?;
            let body = lines.take_while(|line| *line != "}").map(str::trim);
            let fields = body.filter(|line| line.contains(": ")).map(str::to_owned).collect();
            Some(Struct { path: source.path.clone(), fields })
        })
    }

    /// The types of the fields, without what is around them.
    fn types(&self) -> impl Iterator<Item = &str> {
        let last = |field: &str| field.rfind(": ").map(|at| at + 2);
        self.fields.iter().filter_map(move |field| {
            field[last(field)?..].trim_end_matches(',').split(['<', '>']).find(|it| !it.is_empty())
        })
    }
}

/// The most fields of a component.
const MOST_FIELDS: usize = 16;

/// The components of a node own their state: every place that can change it is in one module.
fn assert_walls(node: &str, folder: &str, most_fields: usize, least_components: usize) {
    let folder = format!("automaton/src/network/{folder}/");
    let is_shared =
        |path: &str| path.rsplit_once('/').is_some_and(|(it, _)| it == "automaton/src/network");
    let (own, others): (Vec<Source>, Vec<Source>) =
        sources().into_iter().partition(|source| source.path.starts_with(&folder));
    let shared = others.into_iter().filter(|source| is_shared(&source.path));
    let searched: Vec<Source> = own.into_iter().chain(shared).collect();
    let whole = Struct::find(node, &searched).expect("there is such a node");
    assert!(whole.fields.len() <= most_fields, "{node} has {} fields", whole.fields.len());
    let mut offences = Vec::new();
    let mut count = 0;
    let found = |name| Some((name, Struct::find(name, &searched)?));
    for (name, component) in whole.types().filter(|name| *name != "Site").filter_map(found) {
        count += 1;
        let path = &component.path;
        let open = component.fields.iter().filter(|field| field.starts_with("pub"));
        offences.extend(open.map(|field| format!("{path}: {name} has `{field}`")));
        if component.fields.len() > MOST_FIELDS {
            offences.push(format!("{path}: {name} has {} fields", component.fields.len()));
        }
        let sees_node = [format!("&mut {node}"), format!("self: &{node}")];
        let file = searched.iter().filter(|source| source.path == *path);
        let seen =
            file.flat_map(|source| source.lines_with(&sees_node.each_ref().map(String::as_str)));
        offences.extend(seen);
    }
    assert!(count >= least_components, "{count} components of {node}");
    assert_none(offences, "fields of components are private, few, and changed by their own module");
}

#[test]
fn components_of_a_robot_have_walls() {
    assert_walls("Robot", "robot", 16, 14);
}

#[test]
fn components_of_an_access_point_have_walls() {
    assert_walls("AccessPoint", "access_point", 12, 8);
}
