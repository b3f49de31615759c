//! Chromium without a window, driven over its debugging pipe.
//!
//! The DevTools protocol is JSON objects, each ended by a zero byte; Chromium reads them from file
//! descriptor 3 and writes to 4, which a shell leads to the standard input and output.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

const FLAGS: &str = "--headless --no-sandbox --disable-gpu --disable-quic --no-first-run \
                     --disable-background-networking --disable-component-update --disable-sync \
                     --hide-scrollbars --force-prefers-reduced-motion \
                     --remote-debugging-pipe";

/// A page in a browser of its own.
pub struct Page {
    browser: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    profile: PathBuf,
    session: String,
    calls: u64,
    /// What went wrong on the page: exceptions, and errors and warnings on its console.
    pub complaints: Vec<String>,
}

impl Page {
    /// Opens a file and waits until it has loaded.
    pub fn open(file: &Path, [width, height]: [u32; 2]) -> Page {
        let name = file.file_stem().unwrap().to_string_lossy();
        let profile =
            std::env::temp_dir().join(format!("pleach-browser-{}-{name}", std::process::id()));
        let line = format!(
            "exec chromium {FLAGS} --user-data-dir='{}' about:blank 3<&0 4>&1 </dev/null >/dev/null",
            profile.display()
        );
        let mut browser = Command::new("sh")
            .args(["-c", &line])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let (input, output) = (browser.stdin.take().unwrap(), browser.stdout.take().unwrap());
        let mut page = Page {
            browser,
            input,
            output: BufReader::new(output),
            profile,
            session: String::new(),
            calls: 0,
            complaints: Vec::new(),
        };
        page.attach();
        page.resize([width, height]);
        page.navigate(&format!("file://{}", file.display()));
        page
    }

    fn attach(&mut self) {
        let target = self.call("Target.createTarget", json!({ "url": "about:blank" }));
        let target = json!({ "targetId": target["targetId"], "flatten": true });
        let session = self.call("Target.attachToTarget", target);
        self.session = session["sessionId"].as_str().unwrap().to_owned();
        for domain in ["Page", "Runtime", "Log"] {
            self.call(&format!("{domain}.enable"), json!({}));
        }
    }

    /// Opens the page again.
    pub fn reload(&mut self) {
        self.call("Page.reload", json!({}));
        self.wait_for("Page.loadEventFired");
    }

    fn navigate(&mut self, address: &str) {
        self.call("Page.navigate", json!({ "url": address }));
        self.wait_for("Page.loadEventFired");
    }

    /// Makes the window so large, in pixels.
    pub fn resize(&mut self, [width, height]: [u32; 2]) {
        let size = json!({
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600,
        });
        self.call("Emulation.setDeviceMetricsOverride", size);
    }

    /// As if the system were set to `value` for `feature`, such as `dark` for `color-scheme`. Pages open with less
    /// motion preferred.
    pub fn prefer(&mut self, feature: &str, value: &str) {
        let features = json!([{ "name": format!("prefers-{feature}"), "value": value }]);
        self.call("Emulation.setEmulatedMedia", json!({ "features": features }));
    }

    /// Lays the page out as on paper.
    pub fn lay_out_for_paper(&mut self) {
        self.value("dispatchEvent(new Event('beforeprint'))");
        self.call("Emulation.setEmulatedMedia", json!({ "media": "print" }));
    }

    /// The value of an expression, after what it promises.
    pub fn value(&mut self, expression: &str) -> Value {
        let arguments = json!({
            "expression": expression, "returnByValue": true, "awaitPromise": true,
        });
        let mut answer = self.call("Runtime.evaluate", arguments);
        assert!(answer.get("exceptionDetails").is_none(), "{expression}: {answer}");
        answer["result"]["value"].take()
    }

    /// The value of an expression that is a number.
    pub fn number(&mut self, expression: &str) -> f64 {
        let value = self.value(expression);
        value.as_f64().unwrap_or_else(|| panic!("{expression} is {value}"))
    }

    /// Moves the pointer to the middle of an element, from its upper left corner if `place` says
    /// where, and clicks there.
    pub fn click(&mut self, selector: &str, place: Option<[f64; 2]>) {
        let [x, y] = self.point(selector, place);
        for kind in ["mousePressed", "mouseReleased"] {
            let event = json!({
                "type": kind, "x": x, "y": y, "button": "left", "buttons": 1, "clickCount": 1,
            });
            self.call("Input.dispatchMouseEvent", event);
        }
    }

    /// Moves the pointer; returns where it is in the window.
    pub fn point(&mut self, selector: &str, place: Option<[f64; 2]>) -> [f64; 2] {
        let found = self.value(&format!(
            "(element => {{ element.scrollIntoView({{block: 'nearest'}}); \
             const {{left, top, width, height}} = element.getBoundingClientRect(); \
             return [left, top, width, height]; }})(document.querySelector({}))",
            json!(selector)
        ));
        let found: Vec<f64> = serde_json::from_value(found).unwrap();
        let [dx, dy] = place.unwrap_or([found[2] / 2.0, found[3] / 2.0]);
        let [x, y] = [found[0] + dx, found[1] + dy];
        self.call("Input.dispatchMouseEvent", json!({ "type": "mouseMoved", "x": x, "y": y }));
        [x, y]
    }

    /// Presses and releases a key.
    pub fn press(&mut self, key: &str) {
        let text = if key.chars().count() == 1 { key } else { "" };
        for kind in ["keyDown", "keyUp"] {
            let event = json!({ "type": kind, "key": key, "text": text });
            self.call("Input.dispatchKeyEvent", event);
        }
    }

    /// Keeps what the page looks like, if `PLEACH_SCREENSHOTS` names a folder for that.
    pub fn photograph(&mut self, name: &str) {
        let Some(folder) = std::env::var_os("PLEACH_SCREENSHOTS") else { return };
        let shot = self.call("Page.captureScreenshot", json!({ "format": "png" }));
        std::fs::create_dir_all(&folder).unwrap();
        let path = Path::new(&folder).join(format!("{name}.png"));
        std::fs::write(path, from_base64(shot["data"].as_str().unwrap())).unwrap();
    }

    /// The page on paper, as a PDF document.
    pub fn print(&mut self) -> Vec<u8> {
        let document = self.call("Page.printToPDF", json!({ "printBackground": true }));
        from_base64(document["data"].as_str().unwrap())
    }

    fn call(&mut self, method: &str, arguments: Value) -> Value {
        self.calls += 1;
        let mut message = json!({ "id": self.calls, "method": method, "params": arguments });
        if !self.session.is_empty() {
            message["sessionId"] = json!(self.session);
        }
        self.input.write_all(format!("{message}\0").as_bytes()).unwrap();
        loop {
            let mut answer = self.read();
            if answer["id"] == self.calls {
                assert!(answer.get("error").is_none(), "{method}: {answer}");
                return answer["result"].take();
            }
        }
    }

    fn wait_for(&mut self, event: &str) {
        while self.read()["method"] != event {}
    }

    /// The next message; complaints are kept on the way.
    fn read(&mut self) -> Value {
        let mut bytes = Vec::new();
        self.output.read_until(0, &mut bytes).unwrap();
        assert!(bytes.pop() == Some(0), "Chromium has gone; can it be started here?");
        let message: Value = serde_json::from_slice(&bytes).unwrap();
        let told = &message["params"];
        match message["method"].as_str() {
            Some("Runtime.exceptionThrown") => self.complaints.push(told.to_string()),
            Some("Runtime.consoleAPICalled")
                if matches!(told["type"].as_str(), Some("error" | "warning" | "assert")) =>
            {
                self.complaints.push(told["args"].to_string());
            }
            Some("Log.entryAdded") => self.complaints.push(told["entry"].to_string()),
            _ => {}
        }
        message
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        let _ = self.browser.kill();
        let _ = self.browser.wait();
        let _ = std::fs::remove_dir_all(&self.profile);
    }
}

fn from_base64(text: &str) -> Vec<u8> {
    const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let (mut bytes, mut bits, mut count) = (Vec::new(), 0_u32, 0);
    for digit in text.bytes().filter_map(|byte| DIGITS.iter().position(|digit| *digit == byte)) {
        bits = bits << 6 | digit as u32;
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    bytes
}
