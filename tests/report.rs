//! The HTML report as a person meets it: opened from disk in a browser, turned, clicked.

#![cfg(unix)]

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use common::browser::Browser;
use common::say;

const WEB: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/web");

fn quadmend(folder: &Path, arguments: &[&str]) {
    let run = Command::new(env!("CARGO_BIN_EXE_quadmend"))
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
}

/// Colours of the pixels of a part of a picture.
fn colours(png: &[u8], [left, top, right, bottom]: [u32; 4]) -> Vec<[u8; 3]> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let samples = info.color_type.samples();
    let at = |x: u32, y: u32| {
        let at = (y as usize * info.width as usize + x as usize) * samples;
        [pixels[at], pixels[at + 1], pixels[at + 2]]
    };
    let rows = top..bottom.min(info.height);
    rows.flat_map(|y| (left..right.min(info.width)).map(move |x| (x, y)))
        .map(|(x, y)| at(x, y))
        .collect()
}

/// Keeps a screenshot for people, if they have said where.
fn keep(name: &str, png: &[u8]) {
    if let Some(folder) = std::env::var_os("QUADMEND_SCREENSHOTS") {
        fs::create_dir_all(&folder).unwrap();
        fs::write(PathBuf::from(folder).join(format!("{name}.png")), png).unwrap();
    }
}

/// Where a view is in the window: left, top, right, bottom, without its head.
fn view(browser: &mut Browser, i: usize) -> [u32; 4] {
    let b = browser.value(&format!(
        "(() => {{ const b = document.querySelectorAll('.pane')[{i}].getBoundingClientRect(); \
         return [b.left + 4, b.top + 60, b.right - 4, b.bottom - 4]; }})()"
    ));
    [0, 1, 2, 3].map(|i| b[i].as_f64().unwrap() as u32)
}

/// Share of a view that is not background, and how many colours there are.
fn filled(browser: &mut Browser, i: usize, name: &str) -> (f64, usize) {
    let part = view(browser, i);
    let png = browser.screenshot();
    keep(name, &png);
    let mut all = colours(&png, part);
    let background = all[0];
    let filled = all.iter().filter(|&&c| c != background).count() as f64 / all.len() as f64;
    all.sort_unstable();
    all.dedup();
    (filled, all.len())
}

/// Waits for a frame that is drawn after now, and for the picture to come to rest.
fn settle(browser: &mut Browser) {
    browser.value(
        "new Promise((done) => { const root = document.documentElement; let last; \
         const look = () => { const now = root.dataset.frames; \
         if (now === last) done(true); else { last = now; setTimeout(look, 250); } }; \
         setTimeout(look, 60); })",
    );
}

/// Loads, orbits, picks, recolours; what a report must stand.
fn drive(browser: &mut Browser, file: &Path, name: &str) {
    browser.open(file);
    browser.wait_for("document.documentElement?.dataset.frames > 0");
    settle(browser);
    for i in 0..2 {
        let (share, many) = filled(browser, i, &format!("{name}-opened"));
        assert!(share > 0.04 && many > 50, "{name}: view {i} shows {share:.3}, {many} colours");
    }

    // The middle of a view is not always on the mesh, but somewhere on a cross around it is.
    let [left, top, right, bottom] = view(browser, 1).map(f64::from);
    let mut picked = false;
    for step in 1..60 {
        let share = (f64::from(step) * 0.618).fract();
        let other = (f64::from(step) * 0.755).fract();
        let at = [left + (right - left) * share, top + (bottom - top) * other];
        browser.click(at);
        let info = browser.value("document.querySelector('#info').innerText").to_string();
        picked = info.contains("index") && (info.contains("Vertex") || info.contains("Face"));
        if picked {
            break;
        }
    }
    assert!(picked, "{name}: nothing can be picked");

    let before = browser.screenshot();
    let (x, y) = (0.5 * (left + right), 0.5 * (top + bottom));
    browser.drag([x, y], [x + 160.0, y + 40.0]);
    settle(browser);
    let after = browser.screenshot();
    for i in 0..2 {
        let part = view(browser, i);
        assert_ne!(colours(&before, part), colours(&after, part), "{name}: view {i} does not turn");
    }

    for key in ["angle-deviation", "distance"] {
        browser.choose("colour", key);
        settle(browser);
        let (_, many) = filled(browser, 0, &format!("{name}-{key}"));
        assert!(many > 20, "{name}: {key} has {many} colours");
        assert!(browser.value("document.querySelector('.scale') !== null") == true);
    }
    browser.choose("colour", "");
    browser.choose("domain", "lifted");
    let next = browser.middle(".pane button[title^=next]");
    browser.click(next);
    settle(browser);
    let (share, _) = filled(browser, 0, &format!("{name}-lifted"));
    assert!(share > 0.1, "{name}: the √CC domain is not to be seen");
    let told = browser.value("document.querySelector('.pane .count').innerText").to_string();
    assert!(told.contains("1 of ") || told.contains("0 irregular"), "{name}: {told}");
    browser.value("document.querySelector('canvas').focus()");
    browser.key("p");
    let told = browser.value("document.querySelector('.pane .count').innerText").to_string();
    assert!(told.contains(" of ") || told.contains("0 irregular"), "{name}: {told}");
    browser.choose("domain", "");
    for shading in ["smooth", "wireframe", "flat"] {
        browser.choose("shading", shading);
        settle(browser);
        keep(&format!("{name}-{shading}"), &browser.screenshot());
    }
    assert_eq!(browser.complaints, [""; 0], "{name}");
}

#[test]
fn the_report_works_in_a_browser() {
    let folder = tempfile::tempdir().unwrap();
    let Some(mut browser) = Browser::start("the_report_works_in_a_browser", [1400, 1000]) else {
        return;
    };
    quadmend(folder.path(), &["demo", "-o", "demo", "--quiet"]);
    let report = folder.path().join("demo/report.html");
    drive(&mut browser, &report, "demo");

    let at = browser.middle("table.edits button");
    browser.click(at);
    settle(&mut browser);
    let info = browser.value("document.querySelector('#info').innerText").to_string();
    assert!(info.contains("Edit 1") && info.contains("removed"), "{info}");
    keep("demo-edit", &browser.screenshot());
    browser.value("scrollTo(0, 0)");
    let at = browser.middle("button[name=theme]");
    browser.click(at);
    let at = browser.middle("button[name=reset]");
    browser.click(at);
    settle(&mut browser);
    let dark = browser.screenshot();
    keep("demo-dark", &dark);
    assert_eq!(colours(&dark, [2, 300, 3, 301]), [[0x14, 0x17, 0x1a]]);
    let height = browser.value("document.documentElement.scrollHeight").as_f64().unwrap();
    for (i, top) in (0..).zip((900..height as u32).step_by(900)) {
        browser.value(&format!("scrollTo(0, {top})"));
        keep(&format!("demo-below-{i}"), &browser.screenshot());
    }
    assert_eq!(browser.complaints, [""; 0]);
}

#[test]
fn the_report_needs_nothing_but_itself_and_differs_in_timings_only() {
    let folder = tempfile::tempdir().unwrap();
    let grid = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n";
    fs::write(folder.path().join("<!--<script>&.obj"), grid).unwrap();
    fs::write(folder.path().join("b.obj"), grid).unwrap();
    let write = |name: &str| {
        quadmend(folder.path(), &["compare", "<!--<script>&.obj", "b.obj", "--report", name]);
        fs::read_to_string(folder.path().join(name)).unwrap()
    };
    let report = write("one.html");
    assert!(report == write("two.html"), "the same input gives the same report");
    assert_eq!(report.matches("<script").count(), 2, "no data ends the script");
    for outside in ["src=\"http", "href=\"http", "url(http", "@import", "fetch(\"http"] {
        assert!(!report.contains(outside), "{outside}");
    }
    assert!(!report.contains("@DATA@") && report.ends_with("</html>\n"));
}

#[test]
fn the_bundle_is_what_its_sources_give() {
    use sha2::{Digest, Sha256};
    use std::fmt::Write;
    let sources = fs::read_dir(Path::new(WEB).join("src")).unwrap();
    let mut names: Vec<String> = sources
        .map(|entry| format!("src/{}", entry.unwrap().file_name().into_string().unwrap()))
        .chain(["build.mjs", "package-lock.json", "package.json"].map(str::to_owned))
        .collect();
    names.sort();
    let mut hash = Sha256::new();
    for name in names {
        hash.update(format!("{name}\0"));
        hash.update(fs::read(Path::new(WEB).join(name)).unwrap());
        hash.update("\0");
    }
    let digits = hash.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    });
    for name in ["report.js", "report.css"] {
        let bundle = fs::read_to_string(Path::new(WEB).join("dist").join(name)).unwrap();
        let stamp = format!("/* built from {digits} by npm run build */");
        assert!(bundle.starts_with(&stamp), "web/dist/{name} is stale: run npm run build in web/");
        assert!(!bundle.contains("</script"), "{name} would end its element");
    }
    rebuild();
}

/// Where the tools are installed, the bundle must come out the same to the byte.
fn rebuild() {
    if !Path::new(WEB).join("node_modules/esbuild").is_dir() {
        say("SKIPPED: the_bundle_is_what_its_sources_give: not built again (run npm ci in web/)");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let build = Command::new("node").arg("build.mjs").arg(folder.path()).current_dir(WEB).output();
    let build = build.unwrap();
    assert!(build.status.success(), "{}", String::from_utf8_lossy(&build.stderr));
    for name in ["report.js", "report.css"] {
        let [made, kept] = [folder.path(), &Path::new(WEB).join("dist")]
            .map(|place| fs::read_to_string(place.join(name)).unwrap());
        assert!(made == kept, "web/dist/{name} is not what npm run build makes");
    }
}

/// Reports that were made before: `QUADMEND_REPORTS` names a folder of them.
#[test]
fn reports_at_hand_work_in_a_browser() {
    let Some(folder) = std::env::var_os("QUADMEND_REPORTS") else { return };
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    for file in files.iter().filter(|f| f.extension().is_some_and(|e| e == "html")) {
        let Some(mut browser) = Browser::start("reports_at_hand", [1400, 1000]) else { return };
        let name = file.file_stem().unwrap().to_str().unwrap();
        drive(&mut browser, file, name);
        let first = browser.value("document.documentElement.dataset.firstFrameMs");
        let size = fs::metadata(file).unwrap().len();
        say(&format!("{name}: {:.2} MB, first frame after {first} ms", size as f64 / 1e6));
    }
}
