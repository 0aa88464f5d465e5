//! A headless Chromium that a test drives as a person would: the `DevTools` protocol over its standard
//! streams, real mouse events, screenshots.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use base64::prelude::{BASE64_STANDARD, Engine};
use serde_json::{Value, json};

use super::say;

/// Longest wait for anything.
const PATIENCE: Duration = Duration::from_secs(60);

/// Names under which the browser may be installed.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// A page in a browser.
pub(crate) struct Browser {
    child: Child,
    to: ChildStdin,
    from: Receiver<Value>,
    session: String,
    sent: u64,
    /// Errors that the page has logged or thrown.
    pub(crate) complaints: Vec<String>,
    _profile: tempfile::TempDir,
}

impl Browser {
    /// Starts a browser, or says loudly that there is none and that `test` skips.
    pub(crate) fn start(test: &str, [width, height]: [u32; 2]) -> Option<Self> {
        let named = std::env::var("QUADMEND_CHROMIUM").ok();
        let names = named.as_deref().into_iter().chain(NAMES);
        let there = |name: &&str| {
            let version = Command::new(name).arg("--version").stderr(Stdio::null()).output();
            version.is_ok_and(|out| out.status.success())
        };
        let Some(name) = names.into_iter().find(there) else {
            say(&format!("SKIPPED: {test}: no chromium here (or name it in QUADMEND_CHROMIUM)"));
            return None;
        };
        let profile = tempfile::tempdir().unwrap();
        // The browser takes the protocol on file descriptors 3 and 4.
        let mut child = Command::new("sh")
            .args(["-c", r#"exec "$@" 3<&0 4>&1 >/dev/null 2>&1"#, "sh", name])
            .args(["--headless=new", "--no-sandbox", "--remote-debugging-pipe", "--no-first-run"])
            .args(["--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--hide-scrollbars"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg(format!("--window-size={width},{height}"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (to, out) = (child.stdin.take().unwrap(), child.stdout.take().unwrap());
        let (send, from) = channel();
        std::thread::spawn(move || {
            let mut out = BufReader::new(out);
            let mut message = Vec::new();
            while out.read_until(0, &mut message).is_ok_and(|n| n > 0) {
                message.pop();
                let Ok(value) = serde_json::from_slice(&message) else { return };
                message.clear();
                if send.send(value).is_err() {
                    return;
                }
            }
        });
        let mut browser = Self {
            child,
            to,
            from,
            session: String::new(),
            sent: 0,
            complaints: Vec::new(),
            _profile: profile,
        };
        browser.attach([width, height]);
        Some(browser)
    }

    fn attach(&mut self, [width, height]: [u32; 2]) {
        let target = self.call("Target.createTarget", &json!({ "url": "about:blank" }));
        let to = &json!({ "targetId": target["targetId"], "flatten": true });
        let session = self.call("Target.attachToTarget", to);
        session["sessionId"].as_str().unwrap().clone_into(&mut self.session);
        for domain in ["Page", "Runtime", "Log"] {
            self.call(&format!("{domain}.enable"), &json!({}));
        }
        self.call(
            "Emulation.setDeviceMetricsOverride",
            &json!({
                "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false,
            }),
        );
        // Nothing may come from anywhere but the file itself.
        self.call("Network.enable", &json!({}));
        self.call(
            "Network.emulateNetworkConditions",
            &json!({
                "offline": true, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0,
            }),
        );
    }

    /// Opens a file, without waiting for anything in it.
    pub(crate) fn open(&mut self, file: &Path) {
        let url = format!("file://{}", file.canonicalize().unwrap().display());
        self.call("Page.navigate", &json!({ "url": url }));
    }

    /// The value of an expression on the page.
    pub(crate) fn value(&mut self, expression: &str) -> Value {
        let of = &json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        self.call("Runtime.evaluate", of)["result"]["value"].clone()
    }

    /// Waits until an expression is true on the page.
    #[track_caller]
    pub(crate) fn wait_for(&mut self, expression: &str) {
        let begin = Instant::now();
        while self.value(expression) != json!(true) {
            assert!(begin.elapsed() < PATIENCE, "{expression} never; {:?}", self.complaints);
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// Middle of the first element that a selector finds, scrolled into view.
    pub(crate) fn middle(&mut self, selector: &str) -> [f64; 2] {
        let place = self.value(&format!(
            "(() => {{ const e = document.querySelector({selector:?}); \
             e.scrollIntoView({{ block: 'nearest' }}); const b = e.getBoundingClientRect(); \
             return [b.x + b.width / 2, b.y + b.height / 2]; }})()"
        ));
        [0, 1].map(|i| place[i].as_f64().unwrap_or_else(|| panic!("no {selector}")))
    }

    /// Clicks with the mouse.
    pub(crate) fn click(&mut self, at: [f64; 2]) {
        self.mouse("mouseMoved", at, 0);
        self.mouse("mousePressed", at, 1);
        self.mouse("mouseReleased", at, 0);
    }

    /// Presses at one place and releases at another.
    pub(crate) fn drag(&mut self, from: [f64; 2], to: [f64; 2]) {
        self.mouse("mouseMoved", from, 0);
        self.mouse("mousePressed", from, 1);
        for step in 1..=4 {
            let share = f64::from(step) / 4.0;
            let at = [0, 1].map(|i| from[i] + share * (to[i] - from[i]));
            self.mouse("mouseMoved", at, 1);
        }
        self.mouse("mouseReleased", to, 0);
    }

    fn mouse(&mut self, kind: &str, [x, y]: [f64; 2], buttons: u32) {
        self.call(
            "Input.dispatchMouseEvent",
            &json!({
                "type": kind, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1,
            }),
        );
    }

    /// Presses a key of one letter.
    pub(crate) fn key(&mut self, key: &str) {
        for kind in ["keyDown", "keyUp"] {
            self.call("Input.dispatchKeyEvent", &json!({ "type": kind, "key": key, "text": key }));
        }
    }

    /// Chooses an option as a person would with the keyboard.
    pub(crate) fn choose(&mut self, name: &str, value: &str) {
        self.value(&format!(
            "(() => {{ const s = document.querySelector('select[name={name}]'); \
             s.value = {value:?}; s.dispatchEvent(new Event('change')); }})()"
        ));
    }

    /// The window as a PNG file.
    pub(crate) fn screenshot(&mut self) -> Vec<u8> {
        let shot = self.call("Page.captureScreenshot", &json!({ "format": "png" }));
        BASE64_STANDARD.decode(shot["data"].as_str().unwrap()).unwrap()
    }

    /// Calls a method of the protocol; its result.
    fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.sent += 1;
        let mut message = json!({ "id": self.sent, "method": method, "params": parameters });
        if !self.session.is_empty() {
            message["sessionId"] = json!(self.session);
        }
        self.to.write_all(format!("{message}\0").as_bytes()).unwrap();
        loop {
            let answer =
                self.from.recv_timeout(PATIENCE).unwrap_or_else(|e| panic!("{method}: {e}"));
            if answer["id"] == json!(self.sent) {
                assert!(answer["error"].is_null(), "{method}: {}", answer["error"]);
                return answer["result"].clone();
            }
            self.listen(&answer);
        }
    }

    fn listen(&mut self, event: &Value) {
        let parameters = &event["params"];
        let complaint = match event["method"].as_str() {
            Some("Runtime.exceptionThrown") => Some(parameters["exceptionDetails"].to_string()),
            Some("Runtime.consoleAPICalled") => {
                let serious =
                    ["error", "warning", "assert"].iter().any(|&t| parameters["type"] == t);
                serious.then(|| parameters["args"].to_string())
            }
            Some("Log.entryAdded") => {
                let entry = &parameters["entry"];
                (entry["level"] == "error").then(|| entry["text"].to_string())
            }
            _ => None,
        };
        self.complaints.extend(complaint);
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // Closing its end of the pipe would end it as well, only later.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
