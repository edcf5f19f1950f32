#!/usr/bin/env python3
"""Opens a sweep's report.html in headless Chromium and uses it with mouse and keyboard, through the DevTools protocol.

usage: report_in_browser.py REPORT [--pictures FOLDER]

Prints a line a check and exits with 1 if one fails. With --pictures writes the whole page as PNG, 1280 and 1920 pixels wide.
Python's standard library only.
"""
import base64, json, os, re, shutil, socket, struct, subprocess, sys, tempfile, time
from pathlib import Path


class Socket:
    """A WebSocket client: text messages, one at a time."""

    def __init__(self, port, path):
        self.s = socket.create_connection(("127.0.0.1", port), timeout=60)
        key = base64.b64encode(os.urandom(16)).decode()
        self.s.sendall(f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                       f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        head = b""
        while b"\r\n\r\n" not in head:
            head += self.s.recv(1)
        if b" 101 " not in head.split(b"\r\n")[0]:
            raise RuntimeError(head.decode())

    def send(self, text):
        data, mask = text.encode(), os.urandom(4)
        size = bytes([128 | len(data)]) if len(data) < 126 else struct.pack("!BH", 254, len(data)) if len(data) < 65536 else struct.pack("!BQ", 255, len(data))
        self.s.sendall(b"\x81" + size + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(data)))

    def _read(self, n):
        data = bytearray()
        while len(data) < n:
            part = self.s.recv(n - len(data))
            if not part:
                raise RuntimeError("the browser has gone")
            data += part
        return bytes(data)

    def receive(self):
        data = b""
        while True:
            first, second = self._read(2)
            n = second & 127
            n = struct.unpack("!H", self._read(2))[0] if n == 126 else struct.unpack("!Q", self._read(8))[0] if n == 127 else n
            part = self._read(n)
            if first & 15 < 3:
                data += part
                if first & 128:
                    return data.decode()


class Page:
    def __init__(self, port, path):
        self.socket, self.id, self.requests, self.complaints, self.loaded = Socket(port, path), 0, [], [], False
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    def call(self, method, **parameters):
        self.id += 1
        self.socket.send(json.dumps({"id": self.id, "method": method, "params": parameters}))
        while True:
            message = json.loads(self.socket.receive())
            self.note(message)
            if message.get("id") == self.id:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]

    def note(self, message):
        method, p = message.get("method"), message.get("params", {})
        if method == "Network.requestWillBeSent":
            self.requests.append(p["request"]["url"])
        elif method == "Runtime.exceptionThrown":
            self.complaints.append(p["exceptionDetails"].get("exception", {}).get("description") or p["exceptionDetails"]["text"])
        elif method == "Runtime.consoleAPICalled" and p["type"] in ("error", "assert", "warning"):
            self.complaints.append(str(p["args"]))
        elif method == "Log.entryAdded" and p["entry"]["level"] in ("error", "warning"):
            self.complaints.append(p["entry"]["text"])
        elif method == "Page.loadEventFired":
            self.loaded = True

    def open(self, address, width=1280):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)
        self.loaded = False
        self.call("Page.navigate", url=address)
        while not self.loaded:
            self.note(json.loads(self.socket.receive()))

    def ask(self, script):
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{script}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def click(self, selector, index=0, across=0.5):
        """A real click in the middle of what the selector finds (or at another share of its width)."""
        box = self.ask(f"(() => {{ const e = document.querySelectorAll({json.dumps(selector)})[{index}]; e.scrollIntoView({{block: 'center', inline: 'center'}});"
                       f" const b = e.getBoundingClientRect(); return [b.left + {across} * b.width, b.top + b.height / 2]; }})()")
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=box[0], y=box[1], button="left", clickCount=1)
        self.settle()

    def key(self, name, code, text=None):
        for kind in ("keyDown", "keyUp"):
            more = {"text": text} if text and kind == "keyDown" else {}
            self.call("Input.dispatchKeyEvent", type=kind, key=name, code=name, windowsVirtualKeyCode=code, **more)
        self.settle()

    def settle(self):
        self.ask("new Promise(done => requestAnimationFrame(() => setTimeout(done, 30)))")

    def next_choice(self, selector):
        """The next (or, at the end, the previous) choice of a select, by keyboard."""
        last = self.ask(f"(() => {{ const s = document.querySelector({json.dumps(selector)}); s.focus(); return s.selectedIndex === s.options.length - 1; }})()")
        self.key("ArrowUp", 38) if last else self.key("ArrowDown", 40)

    def picture(self, file):
        data = self.call("Page.captureScreenshot", captureBeyondViewport=True, clip={
            "x": 0, "y": 0, "width": self.ask("innerWidth"), "height": self.ask("document.documentElement.scrollHeight"), "scale": 1})["data"]
        Path(file).write_bytes(base64.b64decode(data))


class Checks:
    failed = 0

    def __call__(self, holds, text):
        print(("ok      " if holds else "FAILED  ") + text, flush=True)
        self.failed += not holds


def use(page, report, check):
    page.open(report.as_uri())
    jobs = page.ask("rows.length")
    check(jobs > 0 and page.ask("document.querySelectorAll('#jobs tbody tr[id]').length") == jobs, f"the table has a row for each of {jobs} jobs")

    points = page.ask("[...document.querySelectorAll('#plot .point')].map(p => p.dataset.job)")
    check(len(points) > 0, f"the plot has points ({len(points)})")
    # one may lie on another and take its clicks
    free = page.ask("""(() => { const svg = document.querySelector('#plot .drawing svg'); svg.scrollIntoView({block: 'center'}); return [...svg.querySelectorAll('.point')].map((p, i) => {
        const b = p.getBoundingClientRect(); return document.elementFromPoint(b.left + b.width / 2, b.top + b.height / 2)?.closest('.point') === p ? i : -1; }).filter(i => i >= 0); })()""")
    check(len(free) >= (len(points) + 2) // 3, f"and most can be clicked ({len(free)})")
    for index in sorted({free[0], free[len(free) // 2], free[-1]}) if free else []:
        page.click("#plot .point", index)
        check(page.ask("document.getElementById('job').open") and points[index] in page.ask("document.getElementById('job').textContent"), f"a click on point {index} opens its job")
        check(page.ask("document.querySelector('#job a').getAttribute('href')") == f"jobs/{points[index]}/run/" and (report.parent / "jobs" / points[index] / "run").is_dir(), "which links to the folder of its run")
        page.key("Escape", 27)
        check(not page.ask("document.getElementById('job').open"), "Escape closes it")
    before = page.ask("document.querySelector('#plot .drawing svg').outerHTML")
    page.next_choice("#plot select")
    check(page.ask("document.querySelector('#plot .drawing svg')?.outerHTML") != before, "another axis draws another plot")

    if page.ask("!!document.getElementById('heat')"):
        cells = "[...document.querySelectorAll('#heat td')].map(c => c.textContent).join()"
        for index, name in ((0, "rows and columns"), (2, "measure")):
            before = page.ask("document.querySelector('#heat table').innerHTML")
            page.ask(f"document.querySelectorAll('#heat select').forEach((s, i) => s.classList.toggle('chosen', i === {index}))")
            page.next_choice("#heat select.chosen")
            check(page.ask("document.querySelector('#heat table').innerHTML") != before, f"the heat map takes another choice of {name}")
        check(page.ask("document.querySelectorAll('#heat td').length") > 1 and page.ask(cells) != "", "and is full")
        page.click("#heat td a")
        check(page.ask("document.getElementById('job').open"), "a click on a cell opens its job")
        page.key("Escape", 27)

    if page.ask("!!document.getElementById('frames')"):
        shown = "[...document.querySelectorAll('#frames img')].map(i => [i.dataset.frame, i.src.length, i.complete && i.naturalWidth > 0])"
        last = page.ask(shown)
        page.click("#frame", across=0.02)
        page.ask("Promise.all([...document.images].filter(i => i.closest('#frames')).map(i => i.decode()))")
        first = page.ask(shown)
        check(all(p[0] == "0" and p[2] for p in first), "the slider's left end shows frame 0 of every job")
        check(all((a[0] != b[0] and a[1] != b[1]) or b[0] == "0" for a, b in zip(first, last)), "and every picture has changed")
        page.key("ArrowRight", 39)
        check(all(p[0] != "0" or l[0] == "0" for p, l in zip(page.ask(shown), last)), "an arrow key goes on by one")

    numeric = page.ask("[...document.querySelectorAll('#jobs thead th')].findIndex((h, i) => i > 0 && h.classList.contains('number') && columns.some(c => c.kind === 'time' && h.textContent.startsWith(c.label)))")
    column = f"[...document.querySelectorAll('#jobs tbody tr[id]')].map(r => r.cells[{numeric}].title).filter(t => t !== '').map(Number)"
    page.click("#jobs thead th button", numeric - 1)
    up = page.ask(column)
    page.click("#jobs thead th button", numeric - 1)
    down = page.ask(column)
    check(len(up) > 0 and up == sorted(up) and down == sorted(up, reverse=True), "a click on a head sorts, another the other way")
    overlaps = page.ask("""(() => { const t = [...document.querySelectorAll('#plot .drawing svg text')].map(e => e.getBoundingClientRect()); let n = 0;
        for (let i = 0; i < t.length; ++i) for (let k = 0; k < i; ++k) n += t[i].left < t[k].right && t[k].left < t[i].right && t[i].top < t[k].bottom - 2 && t[k].top < t[i].bottom - 2; return n; })()""")
    check(overlaps == 0, "no label of the plot lies on another")
    for width in (1280, 1920):
        page.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)
        page.settle()
        check(page.ask("document.documentElement.scrollWidth") <= width, f"nothing is cut off at {width} pixels")

    outside = [u for u in page.requests if not u.startswith("data:") and u != report.as_uri()]
    check(not outside, f"nothing but the page itself is asked for {outside[:3]}")
    check(not page.complaints, f"the console is silent {page.complaints[:3]}")


def in_chromium(work):
    """Calls `work` with a page of a browser of its own. 0, 77 where there is none, 1 where it does not start."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if chromium is None:
        print("skipped: no chromium here")
        return 77
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        command = [chromium, "--headless", "--remote-debugging-port=0", f"--user-data-dir={profile}", "--no-first-run", "--disable-gpu", "--disable-dev-shm-usage", "--disable-background-networking",
                   "--hide-scrollbars", "about:blank"]
        if os.geteuid() == 0:
            command.insert(1, "--no-sandbox")  # a namespace of its own is not to be had by root
        browser = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            port_file, end = Path(profile) / "DevToolsActivePort", time.time() + 60
            while not (port_file.exists() and port_file.read_text().count("\n") >= 1):
                if time.time() > end or browser.poll() is not None:
                    print("FAILED  the browser doesn't start")
                    return 1
                time.sleep(0.05)
            port = int(port_file.read_text().split("\n")[0])
            from urllib.request import urlopen
            targets = json.load(urlopen(f"http://127.0.0.1:{port}/json/list"))
            path = re.sub(r"^ws://[^/]*", "", next(t for t in targets if t["type"] == "page")["webSocketDebuggerUrl"])
            work(Page(port, path))
            return 0
        finally:
            browser.terminate()
            browser.wait()


def main():
    words = sys.argv[1:]
    if not words or len(words) not in (1, 3) or (len(words) == 3 and words[1] != "--pictures"):
        sys.exit(__doc__)
    report, check = Path(words[0]).resolve(), Checks()

    def work(page):
        use(page, report, check)
        if len(words) == 3:
            Path(words[2]).mkdir(parents=True, exist_ok=True)
            for width in (1280, 1920):
                page.open(report.as_uri(), width)
                page.settle()
                page.picture(Path(words[2]) / f"report_{width}.png")

    return in_chromium(work) or (1 if check.failed else 0)


if __name__ == "__main__":
    sys.exit(main())
