#!/usr/bin/env python3
"""Opens a debugger that serves the web in headless Chromium and uses it with mouse and keyboard; then is rude to it.

usage: debugger_in_browser.py ADDRESS PASSWORD FOLDER

ADDRESS as impinge prints it, without the password. Writes what the browser shows as FOLDER/before.png (nothing done yet) and
FOLDER/after.png (the lines and clicks of `use` done). Prints a line a check and exits with 1 if one fails. Python's standard
library only.
"""
import base64, os, socket, struct, sys, time
from pathlib import Path
from urllib.error import HTTPError
from urllib.request import Request, urlopen

sys.path.insert(0, str(Path(__file__).parent))
from report_in_browser import Checks, Socket, in_chromium

PIXELS = "document.getElementById('view').toDataURL('image/png')"


def shown(page, file):
    """The canvas once it has stood still for half a second."""
    last, since, end = "", time.time(), time.time() + 60
    while time.time() - since < 0.5 and time.time() < end:
        now = page.ask(PIXELS)
        if now != last:
            last, since = now, time.time()
        time.sleep(0.05)
    Path(file).write_bytes(base64.b64decode(last.split(",")[1]))


def enter(page, password):
    page.ask("document.getElementById('password').focus()")
    page.ask("document.getElementById('password').value = ''")
    page.call("Input.insertText", text=password)
    page.key("Enter", 13, "\r")


def wait_for(page, condition, seconds=20):
    end = time.time() + seconds
    while time.time() < end:
        if page.ask(condition):
            return True
        time.sleep(0.05)
    return False


def mouse(page, kind, x, y, **more):
    box = page.ask("(() => { const b = document.getElementById('view').getBoundingClientRect(), v = document.getElementById('view'); return [b.left, b.top, b.width / v.width]; })()")
    page.call("Input.dispatchMouseEvent", type=kind, x=box[0] + x * box[2], y=box[1] + y * box[2], **more)


def use(page, address, password, folder, check):
    page.open(address, 1280)
    enter(page, password[:-1])
    check(wait_for(page, "document.getElementById('note').textContent.includes('not the password')"), "a wrong password is refused, and the page says so")
    check(not page.ask("document.getElementById('view').width === 960"), "and shows nothing")
    enter(page, password)
    check(wait_for(page, "document.getElementById('view').width === 960"), "the right one opens the window")
    shown(page, folder / "before.png")
    mouse(page, "mousePressed", 400, 200, button="left", clickCount=1)
    for k in range(1, 9):
        mouse(page, "mouseMoved", 400 + 10 * k, 200 + 2 * k, button="left", buttons=1)
        time.sleep(0.05)
    mouse(page, "mouseReleased", 480, 216, button="left", clickCount=1)
    mouse(page, "mouseMoved", 400, 200)
    mouse(page, "mouseWheel", 400, 200, deltaX=0, deltaY=-200)
    page.settle()
    for _ in range(3):
        page.key("ArrowRight", 39)
        time.sleep(0.2)
    shown(page, folder / "after.png")
    check(folder.joinpath("before.png").read_bytes() != folder.joinpath("after.png").read_bytes(), "mouse and keys change the picture")
    check(not page.complaints, f"the console is silent {page.complaints[:3]}")


def is_rude(address, password, check):
    host, port = address.split("/")[2].split(":")
    port = int(port)

    def fresh():
        return socket.create_connection((host, port), timeout=20)

    for _ in range(50):
        s = Socket(port, "/session")
        s.send("password " + password)
        s.s.close()
    for bytes_ in (os.urandom(4096), b"GET / HTTP/1.1\r\n" + b"a: b\r\n" * 4000, b"\0" * 100000, b"GET /session HTTP/1.1\r\nUpgrade: websocket\r\n\r\n", b""):
        with fresh() as s:
            try:
                s.sendall(bytes_)
            except OSError:
                pass  # cut off while it was still talking
    s = Socket(port, "/session")
    s.send("password " + password)
    s.send("move 1e999 nan")
    closed = False
    try:
        while s.s.recv(65536):
            pass
        closed = True
    except OSError:
        closed = True
    check(closed, "who says what no page says is sent away")
    s = Socket(port, "/session")
    s.s.sendall(b"\x81" + bytes([255]) + struct.pack("!Q", 1 << 40) + b"\0\0\0\0")  # a message of a terabyte
    s.s.settimeout(20)
    try:
        while s.s.recv(65536):
            pass
    except OSError:
        pass
    for path, code in (("/etc/passwd", 404), ("/../../etc/passwd", 404), ("/session", 403)):
        try:
            urlopen(address + path[1:], timeout=20)
            check(False, f"{path} is refused")
        except HTTPError as error:
            check(error.code == code, f"{path} is answered with {error.code}")
    try:
        urlopen(Request(address + "session", headers={"Origin": "http://elsewhere.example", "Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13",
                                                      "Sec-WebSocket-Key": base64.b64encode(os.urandom(16)).decode()}), timeout=20)
        check(False, "another site's page is refused")
    except HTTPError as error:
        check(error.code == 403, "another site's page is refused")
    check(b"impinge" in urlopen(address, timeout=20).read(), "and who is polite is served as before")


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    address, password, folder = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    check = Checks()
    code = in_chromium(lambda page: use(page, address, password, folder, check))
    if code != 0:
        return code
    is_rude(address, password, check)
    return 1 if check.failed else 0


if __name__ == "__main__":
    sys.exit(main())
