"""The page answers to its own address and token alone; the token is in no argument of a process."""

import os
import re
import stat
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from email.message import Message
from http.client import HTTPConnection
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

import pytest

pytest.importorskip("trame")
pytest.importorskip("pyvista")

UPGRADE = {
    "Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
}  # fmt: skip
BROWSER = """
import os, sys
{file}.write_text("\\n".join(sys.argv[1:]) + "\\n" + open("/proc/self/cmdline").read().replace(chr(0), " "))
"""


class Served:
    """A page that is served by a process, and what its browser was started with."""

    def __init__(self, run: Path, folder: Path) -> None:
        self.arguments, script = folder / "arguments", folder / "browser.py"
        script.write_text("from pathlib import Path\n" + BROWSER.format(file=f"Path({str(self.arguments)!r})"))
        self.errors = (folder / "errors").open("w+")
        self.process = subprocess.Popen(
            [sys.executable, "-m", "softway", "view", str(run)], stdout=subprocess.PIPE, stderr=self.errors, text=True,
            env={**os.environ, "BROWSER": f"{sys.executable} {script} %s"},
        )  # fmt: skip
        found = None
        while found is None and (line := self.process.stdout.readline()):
            found = re.search(r"http://\S+", line)
        assert found, (folder / "errors").read_text()
        self.address = urlsplit(found[0])
        self.token = self.address.query.partition("=")[2]

    def get(self, path: str, **headers: str) -> tuple[int, Message, str]:
        """Status, headers and, unless a web socket was opened, text of an answer."""
        with closing(HTTPConnection("127.0.0.1", self.address.port, timeout=60)) as talk:
            talk.request("GET", path, headers=headers)
            with talk.getresponse() as answer:
                return answer.status, answer.headers, "" if answer.status == 101 else answer.read().decode()

    def status(self, path: str, **headers: str) -> int:
        return self.get(path, **headers)[0]

    @property
    def complaints(self) -> str:
        self.errors.flush()
        return Path(self.errors.name).read_text()


@pytest.fixture(scope="module")
def served(square, tmp_path_factory) -> Iterator[Served]:
    made = Served(square.path, tmp_path_factory.mktemp("served"))
    yield made
    made.process.terminate()
    made.process.wait(60)
    made.process.stdout.close()
    made.errors.close()


def cookie(served: Served) -> str:
    status, headers, _ = served.get(f"/?secret={served.token}")
    assert status == 302 and "HttpOnly" in headers["Set-Cookie"] and "SameSite=Strict" in headers["Set-Cookie"]
    return headers["Set-Cookie"].partition(";")[0]


def test_the_page_and_its_files_come_with_the_token(served):
    assert served.status(f"/index.html?secret={served.token}") == 200
    status, headers, text = served.get("/index.html", Cookie=cookie(served))
    assert status == 200 and headers["Referrer-Policy"] == "no-referrer"
    assert "frame-ancestors 'none'" in headers["Content-Security-Policy"]
    script = re.search(r'src="\.?/?([^"]+\.js)"', text)[1]
    assert served.status(f"/{script}", Cookie=cookie(served)) == 200
    assert served.status(f"/{script}") == 403


@pytest.mark.parametrize("path", ["/", "/index.html", "/ws", "/nothing", "/?secret=", "/?secret=wr%C3%B6ng"])
def test_without_the_token_nothing_is_answered(served, path):
    status, headers, text = served.get(path)
    assert status == 403 and "address that was printed" in text and "Set-Cookie" not in headers
    assert served.status(path, Cookie="softway=wrong", **UPGRADE) == 403


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "127.0.0.1.evil.example", "[", "10.0.0.1"])
def test_another_name_of_the_host_is_refused(served, host):
    """Of a name that was rebound to this machine after its page had been loaded."""
    assert served.status(f"/index.html?secret={served.token}", Host=host) in (400, 403)
    assert served.status("/ws", Host=host, Cookie=cookie(served), **UPGRADE) in (400, 403)


def test_a_port_that_ssh_forwards_is_answered(served):
    for host in ("localhost:9000", "127.0.0.1:9000", "[::1]:9000"):
        assert served.status(f"/index.html?secret={served.token}", Host=host) == 200


def test_a_web_socket_of_another_page_is_refused(served):
    own = f"http://127.0.0.1:{served.address.port}"
    for origin, status in ((own, 101), ("http://evil.example", 403), ("null", 403), (f"{own}0", 403)):
        assert served.status("/ws", Origin=origin, Cookie=cookie(served), **UPGRADE) == status


def test_a_plain_request_to_the_web_socket_is_a_wrong_request(served):
    for headers in ({}, {"Upgrade": "websocket"}, {**UPGRADE, "Sec-WebSocket-Key": "short"}):
        assert served.status("/ws", Cookie=cookie(served), **headers) == 400
    assert served.status(f"/index.html?secret={served.token}") == 200
    assert "Traceback" not in served.complaints and "Error" not in served.complaints


@pytest.mark.skipif(not Path("/proc/self/cmdline").exists(), reason="no arguments of processes to read")
def test_no_argument_of_a_process_tells_the_token(served):
    while not served.arguments.exists():
        assert served.process.poll() is None
    given = served.arguments.read_text()
    assert served.token not in given
    assert served.token not in Path(f"/proc/{served.process.pid}/cmdline").read_text()
    file = Path(url2pathname(urlsplit(given.split("\n")[0]).path))
    assert stat.S_IMODE(file.stat().st_mode) == 0o600 and stat.S_IMODE(file.parent.stat().st_mode) == 0o700
    assert served.address.geturl() in file.read_text()
