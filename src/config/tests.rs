//! Each layer, each error, and the files of `configs`.

use super::*;

fn refused(text: &str) -> String {
    match Config::default().with_text("my.toml", text) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("{text} is refused"),
    }
}

fn refused_assignment(text: &str) -> String {
    match Config::default().with_assignment(text) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("{text} is refused"),
    }
}

#[test]
fn later_layers_win() {
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    std::fs::write(file.path(), "[features]\ncrease_deg = 50\n[measure]\nsamples = 5000\n")
        .expect("the file is written");
    let sets = ["measure.samples=7000", "measure.feature_angle_deg = 20.5"];
    let config = Config::load(Some("balanced"), Some(file.path()), &sets).expect("legal");
    assert_eq!((config.measure.samples, config.features.crease_deg), (7000, 50.0));
    assert_eq!(config.get("measure", "feature_angle_deg"), Some(Value::Float(20.5)));
    let none: [&str; 0] = [];
    assert_eq!(Config::load(None, None, &none).expect("legal"), Config::default());
}

#[test]
fn presets_are_legal_and_balanced_is_the_default() {
    for (name, _) in PRESETS {
        Config::preset(name).expect("a preset is legal");
    }
    assert_eq!(Config::preset("balanced").expect("legal"), Config::default());
}

#[test]
fn a_missing_preset_names_the_nearest() {
    let error = Config::preset("balancd").expect_err("no such preset").to_string();
    let wanted =
        "there is no preset `balancd`; did you mean `balanced`? (there are: default, balanced";
    assert!(error.starts_with(wanted), "{error}");
}

#[test]
fn a_missing_file_is_named() {
    let none: [&str; 0] = [];
    let error = Config::load(None, Some(Path::new("no/such.toml")), &none).expect_err("no file");
    assert!(error.to_string().starts_with("no/such.toml: the configuration can not be read"));
}

#[test]
fn syntax_errors_have_their_line() {
    let error = refused("[measure]\nsamples = = 5\n");
    assert!(error.starts_with("my.toml:2: "), "{error}");
    assert!(refused("[measure]\nsamples = 5000\nsamples = 6000\n").starts_with("my.toml:3: "));
}

#[test]
fn unknown_sections_name_the_nearest() {
    let wanted = "my.toml:2: there is no section `mesure`; did you mean `measure`?";
    assert_eq!(refused("\n[mesure]\nsamples = 5000"), wanted);
    let bare = "my.toml:1: there is no section `samples`; did you mean `measure.samples`?";
    assert_eq!(refused("samples = 5000"), bare);
    let set = "--set mesure.samples=1: there is no section `mesure`; did you mean `measure`?";
    assert_eq!(refused_assignment("mesure.samples=1"), set);
}

#[test]
fn unknown_keys_name_the_nearest() {
    let wanted = "my.toml:3: there is no knob `measure.sampels`; did you mean `measure.samples`?";
    assert_eq!(refused("[measure]\n\nsampels = 5000"), wanted);
    let elsewhere = refused("[features]\nsamples = 5000");
    assert!(elsewhere.ends_with("did you mean `measure.samples`?"), "{elsewhere}");
}

#[test]
fn wrong_types_say_what_is_legal() {
    let wanted = "my.toml:2: `measure.samples` takes a whole number from 1000 to 20000000 \
                  (samples), not 5000.5";
    assert_eq!(refused("[measure]\nsamples = 5000.5"), wanted);
    for text in ["measure.samples=many", "measure.samples=", "measure.samples=true"] {
        assert!(refused_assignment(text).contains("takes a whole number"), "{text}");
    }
    assert!(refused("[measure.samples]\nx = 1").contains("takes a whole number"));
}

#[test]
fn values_out_of_range_name_the_nearest_legal_one() {
    let wanted = "my.toml:2: `features.crease_deg` = 200 is out of range: it takes a number from \
                  1 to 180 (degrees); the nearest legal value is 180";
    assert_eq!(refused("[features]\ncrease_deg = 200"), wanted);
    for text in ["features.crease_deg=nan", "features.crease_deg=-inf", "measure.samples=-1"] {
        assert!(refused_assignment(text).contains("is out of range"), "{text}");
    }
}

#[test]
fn assignments_need_a_dot_and_an_equals_sign() {
    for text in ["measure.samples", "samples=5", "", "="] {
        assert!(refused_assignment(text).ends_with("looks like section.key=value"), "{text}");
    }
}

#[test]
fn fields_are_named_as_their_sections() {
    let table = Config::default().table();
    let names: Vec<&str> = table.keys().map(String::as_str).collect();
    assert_eq!(names, SECTIONS.iter().map(|s| s.name).collect::<Vec<_>>());
    for info in SECTIONS {
        let keys: Vec<&str> =
            table[info.name].as_table().expect("a table").keys().map(String::as_str).collect();
        assert_eq!(keys, info.knobs.iter().map(|k| k.name).collect::<Vec<_>>());
    }
}

#[test]
fn defaults_are_inside_their_ranges() {
    let config = Config::default();
    config.clone().with_text("itself", &config.to_toml()).expect("defaults are legal");
}

#[test]
fn commented_files_keep_changed_values() {
    let config = Config::default().with_assignment("measure.samples=9999").expect("legal");
    let text = config.to_toml_commented();
    assert!(text.contains("samples = 9999\n") && text.contains("default 200000."), "{text}");
    assert_eq!(Config::default().with_text("again", &text).expect("legal"), config);
}

#[test]
fn the_schema_has_types_ranges_and_no_room_for_more() {
    let schema = schema();
    let samples = &schema["properties"]["measure"]["properties"]["samples"];
    assert_eq!((&samples["type"], &samples["minimum"]), (&"integer".into(), &1000.0.into()));
    assert_eq!(
        (&samples["default"], &schema["additionalProperties"]),
        (&200_000.into(), &false.into())
    );
    assert!(samples["description"].as_str().is_some_and(|d| d.ends_with("Unit: samples.")));
}

#[test]
fn explanations_find_sections_and_knobs() {
    let text = explain("samples").expect("a knob");
    assert_eq!(text, explain("measure.samples").expect("a knob"));
    assert!(text.contains("1000 to 20000000 (samples); default 200000."), "{text}");
    assert!(explain("measure").is_ok_and(|t| t.contains("measure.feature_angle_deg")));
    let error = explain("mesure.sample").expect_err("no such knob").to_string();
    assert!(error.ends_with("`mesure.sample`; did you mean `measure.samples`?"), "{error}");
}
