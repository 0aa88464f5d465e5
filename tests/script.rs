//! Scripts: addressing, all or nothing, and errors that name the step, the element and the reason.

mod common;

use common::lifted::Block;
use quadmend::config::Config;
use quadmend::mesh::{MendPolicy, Point, PolyMesh, check, shapes};
use quadmend::script::{Edited, OPERATIONS, Script, ScriptError, edit};
use quadmend::watch::Silent;

/// Two T-junctions, stem to stem, in a flat rectangle with coordinates that tell them apart.
fn facing() -> (PolyMesh, [u32; 2]) {
    let block =
        Block::with_t_junction(9, 8, 4, 4).beside(&Block::with_t_junction(9, 8, 4, 4).turned(2));
    let q = block.lifted().0;
    let mesh = quadmend::sqrtcc::lower(&q, &[String::new()]).unwrap().mesh;
    (relaxed(mesh, &block), [block.hanging[0], block.hanging[1]])
}

/// Rim vertices on a rectangle, the others in the mean of their neighbours.
fn relaxed(mut mesh: PolyMesh, block: &Block) -> PolyMesh {
    let mut points = mesh.points().to_vec();
    let corners = [(0.0, 0.0), (19.0, 0.0), (19.0, 8.0), (0.0, 8.0)];
    let mut rim = vec![false; points.len()];
    for (side, sides) in block.sides.iter().enumerate() {
        let (from, to) = (corners[side], corners[(side + 1) % 4]);
        for (i, &v) in sides.iter().enumerate() {
            let t = i as f64 / (sides.len() - 1) as f64;
            let mix = |a: f64, b: f64| a + t * (b - a);
            points[v as usize] = Point::new(mix(from.0, to.0), mix(from.1, to.1), 0.0);
            rim[v as usize] = true;
        }
    }
    let centre = Point::new(9.5, 4.0, 0.0);
    for (point, _) in points.iter_mut().zip(&rim).filter(|(_, on)| !**on) {
        *point = centre;
    }
    for _ in 0..400 {
        let mut sums = vec![(Point::origin().coords, 0.0); points.len()];
        for face in mesh.faces() {
            for i in 0..face.len() {
                let (a, b) = (face[i] as usize, face[(i + 1) % face.len()] as usize);
                sums[a] = (sums[a].0 + points[b].coords, sums[a].1 + 1.0);
                sums[b] = (sums[b].0 + points[a].coords, sums[b].1 + 1.0);
            }
        }
        for v in (0..points.len()).filter(|&v| !rim[v]) {
            points[v] = Point::from(sums[v].0 / sums[v].1);
        }
    }
    mesh.set_points(points);
    mesh
}

fn run_on(mesh: PolyMesh, text: &str, keep_going: bool) -> Result<Edited, ScriptError> {
    let script = Script::parse(text, "edits.toml")?;
    let config = Config::default();
    edit(mesh, None, MendPolicy::Strict, &script, (&config, keep_going), &Silent)
}

fn run(text: &str) -> Result<Edited, ScriptError> {
    run_on(facing().0, text, false)
}

fn refusal(text: &str) -> String {
    run(text).expect_err("the script is wrong").to_string()
}

#[test]
fn t_junctions_by_number_and_by_place_cancel_to_the_same_mesh() {
    let (mesh, [a, b]) = facing();
    let place = mesh.points()[a as usize];
    let by_number = format!(
        "[[step]]\ndo = \"cancel-t-junctions\"\nat = {{ vertex = {} }}\nwith = {{ vertex = {} }}",
        a + 1,
        b + 1
    );
    let by_place = format!(
        "[[step]]\ndo = \"cancel-t-junctions\"\nat = {{ nearest = [{}, {}, 0.0] }}",
        place.x, place.y
    );
    let [first, second] = [by_number, by_place].map(|text| run(&text).unwrap());
    assert_eq!(first.mesh, second.mesh);
    check(&first.mesh).unwrap();
    assert!(first.mesh.faces().all(|f| f.len() == 4), "nothing is left");
    assert_eq!((first.steps[0].before, first.steps[0].after), (4, 0));
}

#[test]
fn a_selection_is_moved_one_by_one_and_results_can_be_referred_to() {
    let edited = run("
        [[step]]
        do = 'move-t-junction'
        at = { all = 't-junctions', within = { min = [0, 0, -1], max = [9, 8, 1] } }
        to = 'down'

        [[step]]
        do = 'move-t-junction'
        at = { step = 1 }
        to = 'up'

        [[step]]
        do = 'walk'
        at = { step = 2, result = 1 }
        steps = ['climb-left', 'climb-right']

        [[step]]
        do = 'smooth'
        iterations = 5
    ")
    .unwrap();
    assert_eq!(edited.steps.len(), 4);
    assert!(edited.steps.iter().all(|step| step.after == 4), "{:?}", edited.steps);
    assert!(edited.steps[3].ops.is_empty());
}

#[test]
fn pairs_move_change_type_merge_and_convert() {
    let edited = run("
        [[step]]
        do = 'cancel-t-junctions'
        at = { all = 't-junctions' }

        [[step]]
        do = 'generate-pairs'
        at = { nearest = [9.5, 4, 0] }
        what = 't-junctions'

        [[step]]
        do = 'move-t-junction'
        at = { step = 2 }
        to = 'down'
        edges = 2

        [[step]]
        do = 'change-type'
        at = { step = 3, result = 1 }
        with = { step = 3, result = 2 }

        [[step]]
        do = 'change-type'
        at = { step = 4, result = 1 }
        with = { step = 4, result = 2 }

        [[step]]
        do = 'cancel-quadruple'
        at = { all = 'dislocations' }

        [[step]]
        do = 'edge-shift'
        fixed = { nearest = [9.5, 4, 0] }
        from = { vertex = 1 }
        to = { vertex = 2 }
    ");
    let error = edited.expect_err("the last step is nonsense").to_string();
    assert!(error.contains("step 7 (edge-shift"), "{error}");
    assert!(error.contains("not joined"), "{error}");
}

#[test]
fn the_log_replays_to_the_same_bytes() {
    let (mesh, [a, _]) = facing();
    let place = mesh.points()[a as usize];
    let text = format!(
        "[[step]]\ndo = \"move-t-junction\"\nat = {{ nearest = [{}, {}, 0.0] }}\nto = \"right\"\n\
         [[step]]\ndo = \"cancel-t-junctions\"\nat = {{ all = \"t-junctions\" }}\n",
        place.x, place.y
    );
    let edited = run(&text).unwrap();
    let mut replay = String::new();
    for op in edited.steps.iter().flat_map(|step| &step.ops) {
        // An operation in the log has the key `op` where a step has `do`.
        let step = toml::to_string(op).unwrap().replacen("op =", "do =", 1);
        replay = [&replay, "[[step]]\n", &step, "\n"].concat();
    }
    assert_eq!(run(&replay).unwrap().mesh, edited.mesh);
}

#[test]
fn an_error_names_the_step_the_element_and_the_reason() {
    let first = "[[step]]\ndo = \"smooth\"\niterations = 1\n\n";
    for (step, parts) in [
        ("do = 'edge-collapse'\nedge = { vertices = [1, 2] }", &["vertex 1", "boundary"][..]),
        ("do = 'edge-collapse'\nedge = { vertices = [1, 999] }", &["no vertex 999", "1 to "]),
        ("do = 'move-t-junction'\nat = { vertex = 1 }\nto = 'up'", &["vertex 1", "T-junction"]),
        ("do = 'merge'\nat = { vertex = 30 }", &["vertex 30", "valence or degree"]),
        ("do = 'merge'\nat = { nearest = [0, 0, 0], kind = 'six' }", &["no element of six edges"]),
        ("do = 'convert'\nat = { all = 'six' }", &["the selection is empty"]),
        ("do = 'convert'\nat = { step = 2 }", &["step 2 has not been made"]),
        ("do = 'split'\nfirst = 0\nlast = 99999", &["no longer exists"]),
        (
            "do = 'move-pair'\nat = { nearest = [0, 0, 0], kind = 'v3' }\n\
             with = { nearest = [0, 0, 0], kind = 'f5' }\nto = 'closer'",
            &["Proposition 3.4"],
        ),
    ] {
        let error = refusal(&format!("{first}[[step]]\n{step}\n"));
        let name = step.split('\'').nth(1).unwrap();
        assert!(error.starts_with(&format!("step 2 ({name}, line 5)")), "{error}");
        for part in parts {
            assert!(error.contains(part), "{part} in: {error}");
        }
    }
}

#[test]
fn a_text_that_is_no_script_names_file_line_and_fault() {
    for (text, parts) in [
        ("[[step]\n", &["edits.toml:1:"][..]),
        ("", &["edits.toml", "no steps"]),
        ("[[steps]]\n", &["edits.toml:1:", "step"]),
        ("\n[[step]]\nat = { vertex = 1 }\n", &["edits.toml:2: step 1", "do ="]),
        ("[[step]]\ndo = 'smoth'\n", &["step 1", "did you mean `smooth`"]),
        ("[[step]]\ndo = 'smooth'\ntimes = 3\n", &["smooth:", "unknown field `times`"]),
        ("[[step]]\ndo = 'merge'\n", &["merge:", "missing field `at`"]),
        ("[[step]]\ndo = 'merge'\nat = { vertex = 1, face = 2 }\n", &["exactly one of"]),
        (
            "[[step]]\ndo = 'merge'\nat = { vertex = 1, within = { min = [0,0,0], max = [1,1,1] } }\n",
            &["`within` goes with `all`"],
        ),
        ("[[step]]\ndo = 'flip'\nedge = 3\nturn = 'ccw'\nwhy = 1\n", &["flip:", "why"]),
    ] {
        let error = Script::parse(text, "edits.toml").expect_err(text).to_string();
        for part in parts {
            assert!(error.contains(part), "{part} in: {error}");
        }
    }
}

#[test]
fn keeping_going_makes_what_can_be_made_and_says_what_was_not() {
    let text = "
        [[step]]
        do = 'merge'
        at = { vertex = 1 }

        [[step]]
        do = 'cancel-t-junctions'
        at = { all = 't-junctions' }

        [[step]]
        do = 'convert'
        at = { step = 1 }
    ";
    assert!(run(text).is_err());
    let edited = run_on(facing().0, text, true).unwrap();
    assert_eq!(edited.steps.len(), 1);
    assert_eq!(edited.refused.iter().map(|r| r.number).collect::<Vec<_>>(), [1, 3]);
    assert!(edited.mesh.faces().all(|f| f.len() == 4));
}

#[test]
fn numbers_of_a_mesh_that_had_to_be_mended_are_not_trusted() {
    let grid = shapes::grid(6, 6);
    let mut points = grid.points().to_vec();
    points.push(Point::new(9.0, 9.0, 9.0));
    let stray = PolyMesh::new(points, grid.faces()).unwrap();
    let script =
        Script::parse("[[step]]\ndo = 'merge'\nat = { vertex = 3 }", "edits.toml").unwrap();
    let config = Config::default();
    let refused = edit(stray, None, MendPolicy::Mend, &script, (&config, false), &Silent);
    let error = refused.expect_err("the numbers may have changed").to_string();
    assert!(error.contains("had to be mended"), "{error}");
}

/// The sample mesh with a script, on its own surface.
fn on_the_sample(text: &str) -> Edited {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let mesh = quadmend::io::read(&folder.join("assets/bracket.obj")).unwrap().mesh;
    let script = Script::parse(text, "edits.toml").unwrap();
    let config = Config::default();
    edit(mesh, None, MendPolicy::Mend, &script, (&config, false), &Silent).unwrap()
}

#[test]
fn disks_are_regularised_and_pure_quads_made() {
    let edited = on_the_sample(
        "
        [[step]]
        do = 'regularize'
        at = { all = 'irregular' }
        most = 40

        [[step]]
        do = 'pure-quad'

        [[step]]
        do = 'faces-from-vertices'

        [[step]]
        do = 'pure-quad'
    ",
    );
    let [regular, quads, faces, _] = &edited.steps[..] else { panic!("four steps") };
    assert!(regular.after < regular.before / 2, "{}", regular.done);
    assert!(!regular.refills.is_empty() && regular.ops.is_empty());
    assert!(quads.done.contains(" left") && !quads.ops.is_empty(), "{}", quads.done);
    assert!(!faces.ops.is_empty(), "{}", faces.done);
    let odd = edited.mesh.faces().filter(|face| face.len() != 4).count();
    assert!(odd <= 2, "{odd} faces are left: {}", edited.steps[3].done);
    check(&edited.mesh).unwrap();
}

#[test]
fn a_set_of_faces_is_regularised_and_the_mesh_optimised() {
    let edited = run("
        [[step]]
        do = 'regularize'
        faces = [{ all = 'faces', within = { min = [3, 2, -1], max = [16, 6, 1] } }]
        most = 200

        [[step]]
        do = 'optimize'
        goal = 'angles'

        [[step]]
        do = 'optimize'
        goal = 'planar'
    ")
    .unwrap();
    assert_eq!((edited.steps[0].before, edited.steps[0].after), (4, 0));
    assert_eq!(edited.steps[0].refills.len(), 1);
    assert!(edited.steps[1].done.contains("angles"), "{}", edited.steps[1].done);
    assert!(edited.mesh.faces().all(|f| f.len() == 4));
    let both = "[[step]]\ndo = 'regularize'\nat = { vertex = 1 }\nfaces = [{ face = 1 }]";
    assert!(refusal(both).contains("either `at`"));
}

#[test]
fn every_operation_has_a_name_of_its_own_and_words() {
    let mut names: Vec<&str> = OPERATIONS.iter().map(|kind| kind.name).collect();
    assert!(OPERATIONS.iter().all(|kind| !kind.about.is_empty()));
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), OPERATIONS.len());
}

#[test]
fn the_script_of_the_readme_goes_through() {
    let readme = include_str!("../README.md");
    let block =
        readme.split("```toml\n# edits.toml").nth(1).and_then(|rest| rest.split("```").next());
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let mesh = quadmend::io::read(&folder.join("assets/bracket.obj")).unwrap().mesh;
    let script = Script::parse(block.expect("a script"), "README.md").unwrap();
    let config = Config::default();
    let edited = edit(mesh, None, MendPolicy::Mend, &script, (&config, false), &Silent).unwrap();
    assert_eq!(edited.steps.len(), script.len());
    assert!(edited.steps[2].after < edited.steps[0].before, "{:?}", edited.steps);
}
