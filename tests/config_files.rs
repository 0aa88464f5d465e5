//! The files of `configs` are what the code says.

use quadmend::config::{Config, PRESETS};

/// `QUADMEND_WRITE_CONFIGS=1 cargo test --test config_files` writes the file anew.
#[test]
fn default_toml_is_what_the_code_says() {
    let wanted = Config::default().to_toml_commented();
    if std::env::var_os("QUADMEND_WRITE_CONFIGS").is_some() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/configs/default.toml");
        std::fs::write(path, wanted).expect("configs can be written");
        return;
    }
    let hint =
        "run `QUADMEND_WRITE_CONFIGS=1 cargo test --test config_files`, then look at the change";
    assert!(PRESETS[0].1 == wanted, "configs/default.toml is out of date: {hint}");
    let read = Config::preset("default").expect("the default is legal");
    assert_eq!(read, Config::default());
}

#[test]
fn every_file_of_configs_is_a_preset() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/configs");
    let entries = std::fs::read_dir(folder).expect("there are configs");
    for entry in entries {
        let file = entry.expect("an entry can be read").file_name();
        let Some(name) = file.to_string_lossy().strip_suffix(".toml").map(str::to_owned) else {
            continue;
        };
        // The one that is no configuration, but says how to search for one.
        if name == "tune" {
            continue;
        }
        assert!(PRESETS.iter().any(|(known, _)| *known == name), "{name} is not in PRESETS");
    }
}
