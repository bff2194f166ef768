"""The page in a browser without a screen: it shows, it moves, it follows, and it talks to this machine alone."""

import io
import os
import re
import shutil
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from urllib.parse import urlsplit

import numpy as np
import pytest
from PIL import Image

import softway as sw
from softway.apps.verify import chosen, examined
from softway.apps.verify.page import page as report
from softway.record.view.bodies.bodies import instant

sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed: make test-view installs it")
pytest.importorskip("trame")
CHROMIUM = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), None
)
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium found (Debian: apt-get install chromium)")
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"]
FLAGS += ["--disable-component-update", "--disable-sync", "--disable-quic"]
FLAGS += ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
LONG = 300.0
"""Seconds for what takes one or two on a machine that does nothing else."""


@contextmanager
def served(*words: str) -> Iterator[str]:
    """The address of the page that ``softway view`` serves."""
    command = [sys.executable, "-m", "softway", "view", *words, "--no-browser"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=os.environ)
    try:
        text = ""
        for line in process.stdout:
            text += line
            if found := re.search(r"http://\S+", line):
                yield found[0]
                break
        else:
            pytest.fail(text)
    finally:
        process.terminate()
        try:
            process.wait(LONG)
        finally:
            process.kill()
            process.stdout.close()


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with sync_api.sync_playwright() as driver:
        folder = str(tmp_path_factory.mktemp("profile"))
        made = driver.chromium.launch_persistent_context(
            folder,
            executable_path=CHROMIUM,
            args=FLAGS,
            viewport={"width": 1000, "height": 700},
            timeout=1e3 * LONG,
        )
        made.set_default_timeout(1e3 * LONG)
        sync_api.expect.set_options(timeout=1e3 * LONG)
        yield made
        made.close()


@contextmanager
def opened(browser, address):
    """A page, and the hosts that it asked."""
    page, asked = browser.new_page(), []
    page.on("request", lambda request: asked.append(urlsplit(request.url)))
    page.on("websocket", lambda talk: asked.append(urlsplit(talk.url)))
    page.goto(address)
    try:
        yield page, asked
    finally:
        page.close()


def seen(page):
    """Pixels (h, w, 3) of the window."""
    picture = page.locator("#window canvas").first.screenshot()
    return np.asarray(Image.open(io.BytesIO(picture)).convert("RGB"), float)


def shows(page, name, text):
    """Wait until a part of the page has a text."""
    sync_api.expect(page.locator(f"#{name}")).to_have_text(text)


def settled(page):
    """The window once two pictures of it are alike and not empty."""
    before, begun = np.zeros(1), time.monotonic()
    while time.monotonic() - begun < LONG:
        page.wait_for_timeout(250)
        now = seen(page)
        if now.shape == before.shape and np.ptp(now) > 50.0 and not np.abs(now - before).any():
            return now
        before = now
    pytest.fail("the window does not settle")


def test_the_page_shows_the_run_and_moves(square, browser):
    with served(str(square.path)) as address, opened(browser, address) as (page, asked):
        page.wait_for_selector("#clock")
        first = settled(page)
        assert page.locator("#heading").inner_text() == "A fall"
        assert len(np.unique(first.reshape(-1, 3), axis=0)) > 5
        page.locator(".v-slider-thumb").focus()
        for _ in range(3):
            page.keyboard.press("ArrowRight")
        shows(page, "clock", "1.2 s")
        last = settled(page)
        assert (np.abs(last - first).max(axis=2) > 30.0).mean() > 0.01
        page.locator("#play").click()
        sync_api.expect(page.locator("#clock")).not_to_have_text("1.2 s")
        page.locator("#play").click()
        page.get_by_role("tab", name=re.compile("events")).click()
        rows = page.locator("#events tbody tr")
        sync_api.expect(rows).to_have_count(len(square.events["time"]))
        rows.first.click()
        first_touch = float(square.events["time"][0])
        nearest = square.fields.times[np.argmin(np.abs(square.fields.times - first_touch))]
        shows(page, "clock", instant(nearest))
        assert {place.hostname for place in asked if place.scheme not in ("data", "blob")} == {"127.0.0.1"}
        assert any(place.scheme == "ws" for place in asked)


def test_keys_work_from_the_start_and_a_phone_shows_bodies_and_curves(square, browser):
    with served(str(square.path)) as address, opened(browser, address) as (page, _):
        shows(page, "clock", "0 s")
        page.locator("#window").click()
        page.locator(".page").focus()
        page.keyboard.press("ArrowRight")
        shows(page, "clock", "400 ms")
        page.keyboard.press("ArrowLeft")
        shows(page, "clock", "0 s")
        page.keyboard.press(" ")
        sync_api.expect(page.locator("#clock")).not_to_have_text("0 s")
        page.keyboard.press(" ")
        page.set_viewport_size({"width": 390, "height": 844})
        window, beside = (page.locator(name).bounding_box() for name in ("#window", ".beside"))
        assert window["width"] == beside["width"] == 390.0
        assert window["height"] > 200.0 and beside["y"] == window["y"] + window["height"]
        page.set_viewport_size({"width": 1000, "height": 700})


def test_the_page_of_the_suite_fits_a_phone(browser):
    page = browser.new_page()
    page.set_viewport_size({"width": 360, "height": 700})
    page.set_content(report([examined(chosen(["A01"])[0])]))
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    page.close()


def test_only_this_machine_with_the_token_is_answered(square, browser):
    """Another address of the loopback is refused, as it would not be if all were listened to."""
    with served(str(square.path)) as address:
        port = urlsplit(address).port
        with pytest.raises(ConnectionRefusedError), socket.create_connection(("127.0.0.2", port), 2):
            pass
        with opened(browser, address.partition("?")[0]) as (page, _):
            page.wait_for_timeout(3000)
            assert page.locator("#clock").count() == 0


def test_a_run_that_goes_on_is_followed(tmp_path, browser, fall):
    """The page is opened while the run rests after half its slabs; the others appear by themselves."""
    go_on, half = threading.Event(), threading.Event()

    def rest(progress):
        if progress.time > 2.0 and not half.is_set():
            half.set()
            go_on.wait(4 * LONG)

    made = fall(sw.meshes.Interval(length=1.0, cells=5), -0.1)
    work = threading.Thread(target=lambda: sw.run(made, tmp_path / "run", progress=rest))
    work.start()
    assert half.wait(LONG)
    with served(str(tmp_path / "run"), "--live") as address, opened(browser, address) as (page, _):
        shows(page, "status", "running")
        shows(page, "clock", "2 s")
        go_on.set()
        shows(page, "clock", "4 s")
        shows(page, "status", "done")
    work.join()
