"""Page of the bench on a real server, attacked by raw websocket clients; no browser."""

import gc
import os
import socket
import time
import urllib.error
import urllib.request
from typing import Any

import pytest

from tests.patience import HANG
from vehicle.errors import ConfigurationError
from vehicle.handover.bench.guard import Guard
from vehicle.handover.bench.state import BenchState

viser = pytest.importorskip("viser", reason="viser is missing: pip install 'vehicle-on-shaker[bench]'")
msgspec = pytest.importorskip("msgspec")

from websockets.exceptions import InvalidStatus  # noqa: E402
from websockets.sync.client import connect  # noqa: E402

from vehicle.handover.bench.page import Page  # noqa: E402
from vehicle.handover.bench.server import _report, close_server, open_server  # noqa: E402
from vehicle.handover.bench.stage import CYCLE  # noqa: E402
from vehicle.handover.bench.view import RUN  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
"""Rejected and killed clients leave their sockets to the garbage collector."""

FRICTION = "front.damper.coulomb_friction"
SPEAKS = [f"viser-v{viser.__version__}"]

CAMERA = {
    "type": "ViewerCameraMessage",
    **dict.fromkeys(("fov", "near", "far"), 1.0),
    **dict.fromkeys(("image_height", "image_width"), 100),
    **dict.fromkeys(("position", "look_at", "up_direction"), (0.0, 0.0, 1.0)),
    "wxyz": (1.0, 0.0, 0.0, 0.0),
}


class Bench:
    """A running bench."""

    def __init__(self, car, drive, folder):
        self.guard = Guard()
        self.server = open_server(self.guard, 8700)
        self.port, self.folder = self.server.get_port(), folder
        state = BenchState(car, drive)
        self.page = Page(self.server, state, folder)

    @property
    def slider(self):
        return self.page._sliders[FRICTION]

    def client(self, **changed):
        options = {"origin": f"http://127.0.0.1:{self.port}", "subprotocols": SPEAKS, "max_size": None, **changed}
        path = options.pop("path", f"/{self.guard.token}")
        client = connect(f"ws://127.0.0.1:{self.port}{path}", proxy=None, **options)
        client.send(msgspec.msgpack.encode(CAMERA))  # the first message of every browser
        return client

    def send(self, client, value, path=FRICTION):
        self.set(client, self.page._sliders[path], value)

    def set(self, client, handle, value):
        """Set the value of an element as a browser does."""
        client.send(
            msgspec.msgpack.encode({"type": "GuiUpdateMessage", "uuid": handle._impl.uuid, "updates": {"value": value}})
        )

    def wait_for(self, condition):
        until = time.monotonic() + HANG
        while not condition():
            assert time.monotonic() < until, "the page does not follow"
            time.sleep(0.02)

    def follows(self, client, value):
        """Move the slider and wait for the numbers of this value."""
        self.send(client, value)
        self.wait_for(lambda: self.page.state.present[0].overrides == (f"{FRICTION}={float(value)!r}",))
        self.wait_for(lambda: f"**B** front damper Coulomb friction {value:g} N" in self.page._table.content)


@pytest.fixture(scope="module")
def bench(car, drive, tmp_path_factory):
    bench = Bench(car, drive, tmp_path_factory.mktemp("bench") / "files")
    yield bench
    bench.page.close()
    close_server(bench.server)


def received(client):
    """First message of the server."""
    return client.recv(timeout=HANG)


def test_the_server_listens_on_this_machine_alone(bench):
    # A server on all addresses would answer here too.
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.2", bench.port), timeout=HANG)


def test_the_page_is_served_behind_the_token_alone(bench):
    address = bench.guard.address(bench.port)
    with urllib.request.urlopen(address, timeout=HANG) as answer:
        assert b"<html" in answer.read()[:2000].lower()
        assert answer.headers["X-Frame-Options"] == "DENY" and answer.headers["Referrer-Policy"] == "no-referrer"
    root = f"http://127.0.0.1:{bench.port}"
    for path in ("/", "/index.html", f"/x{bench.guard.token}/", f"/{bench.guard.token}/../../server.py"):
        with pytest.raises(urllib.error.HTTPError) as caught:
            urllib.request.urlopen(f"{root}{path}", timeout=HANG)
        with caught.value:
            assert caught.value.code in (403, 404)


@pytest.mark.parametrize(
    "changed",
    [
        {"origin": "http://attacker.example"},
        {"origin": None},
        {"origin": "null"},
        {"path": "/"},
        {"path": "/wrong"},
        {"additional_headers": {"Host": "attacker.example"}},
        {"additional_headers": {"Origin": "http://attacker.example"}},
    ],
    ids=str,
)
def test_foreign_websockets_are_rejected_before_they_are_accepted(bench, changed):
    before = bench.guard.rejected
    with pytest.raises(InvalidStatus) as caught, bench.client(**changed) as client:
        received(client)
    assert caught.value.response.status_code == 403
    assert bench.guard.token.encode() not in caught.value.response.body
    assert bench.guard.rejected == before + 1


def test_numbers_follow_a_slider_and_two_windows_show_them(bench):
    with bench.client() as first, bench.client() as second:
        assert len(received(first)) > 100 and len(received(second)) > 100
        bench.follows(first, 60.0)
        assert bench.slider.value == 60.0
        bench.follows(second, 90.0)
        assert "| comfort unweighted [m/s2] |" in bench.page._table.content


def test_absurd_values_change_nothing(bench, capsys, caplog):
    with bench.client() as client:
        for value in (1e300, -5.0, float("nan"), float("inf"), "text", None, [1.0], {"a": 1}, 2**63):
            bench.follows(client, 70.0)
            try:
                bench.send(client, value)
            except OverflowError:
                client.send(b"\xff" * 100)
            if isinstance(value, float) and value == value:
                # The value arrives, and the slider is put back.
                bench.wait_for(lambda: "must be" in bench.page._note.content or "found" in bench.page._note.content)
                bench.wait_for(lambda: bench.slider.value == 70.0)
            bench.follows(client, 80.0)
            bench.wait_for(lambda: bench.slider.value == 80.0)


def test_values_of_a_wrong_type_are_ignored_in_a_line_each(bench, capfd, caplog):
    """Also for other properties than the value, and for lists and check boxes."""
    view = bench.page.view
    wrong: list[object] = ["text", None, [1.0], {"a": 1}, {}, [[]], b"\x1b[2J\n", True]
    with bench.client() as client:
        for handle in (bench.slider, view.kind, view.larger, view.playing):
            kept = handle.value
            for value in wrong:
                bench.set(client, handle, value)
            bench.set(client, handle, kept)
        unknown = {"type": "GuiUpdateMessage", "uuid": bench.slider._impl.uuid, "updates": {"no such property": 1}}
        client.send(msgspec.msgpack.encode(unknown))
        bench.follows(client, 75.0)
        gc.collect()  # an error that nobody has looked at is reported when its task is collected
        bench.follows(client, 76.0)
    said = capfd.readouterr().err
    ignored = [line for line in said.splitlines() if line.startswith("bench: ") and "ignored" in line]
    assert len(ignored) >= 10 and "Traceback" not in said and "\x1b" not in said
    assert not any(record.exc_info for record in caplog.records)


def test_an_event_without_an_exception_is_described_by_its_message(capfd):
    loop: Any = None
    _report(loop, {"message": "Task was destroyed but it is pending!\n"})
    assert capfd.readouterr().err.endswith("(Task was destroyed but it is pending!)\n")
    _report(loop, {"message": "Task exception was never retrieved", "exception": ValueError("no number")})
    assert capfd.readouterr().err.endswith("(ValueError: no number)\n")


def test_garbage_and_closed_browsers_do_not_end_the_bench(bench, capfd, caplog):
    for content in (b"", b"\x00", os.urandom(2000), msgspec.msgpack.encode({"type": "NoSuchMessage"})):
        with bench.client() as client:
            client.send(content)
    client = bench.client()
    client.socket.close()  # as a browser that is killed
    with bench.client() as client:
        bench.follows(client, 65.0)
    said = capfd.readouterr().err
    assert "bench: a connection was closed (" in said and "Traceback" not in said
    assert not any(record.exc_info for record in caplog.records)


def test_nobody_gets_a_tunnel_to_the_internet(bench):
    with bench.client() as client:
        client.send(msgspec.msgpack.encode({"type": "ShareUrlRequest"}))
        bench.follows(client, 75.0)
    assert bench.server._share_tunnel is None


def test_files_are_written_by_a_click_alone(bench):
    with bench.client() as client:
        bench.follows(client, 85.0)
        assert not bench.folder.exists()
        button = next(
            handle for handle in bench.server.gui._gui_input_handle_from_uuid.values()
            if getattr(handle, "label", "") == "Write vehicle file"
        )  # fmt: skip
        bench.set(client, button, True)
        bench.wait_for(lambda: (bench.folder / "car" / "vehicle.toml").exists())
        bench.wait_for(lambda: "written" in bench.page._note.content)
    assert "coulomb_friction = 85" in (bench.folder / "car" / "vehicle.toml").read_text()


def test_a_searched_parameter_gets_a_slider(bench):
    path = "front.hardpoints.strut_top.z"
    bench.page.add_slider(path, more=True)
    with bench.client() as client:
        slider, value = bench.page._sliders[path], bench.page.state.setting(path).value
        assert slider.label.endswith("strut top z [mm]") and slider.value == pytest.approx(1e3 * value, rel=5e-4)
        bench.send(client, 1e3 * value + 10.0, path)
        bench.wait_for(lambda: bench.page.state.changes.get(path) == pytest.approx(value + 0.01))
        bench.wait_for(lambda: f"strut top z {1e3 * value + 10.0:.5g} mm" in bench.page._table.content)
    bench.page._reset()
    bench.wait_for(lambda: "**B** unchanged" in bench.page._table.content)


def test_large_values_have_a_prefix_as_the_field_shows_five_digits_alone(bench):
    path = "front.bushings.tyre.stiffness.z"
    slider = bench.page._sliders[path]
    assert slider.label == "front tyre stiffness z [kN/m]" and (slider.value, slider.max) == (250.0, 1000.0)
    with bench.client() as client:
        bench.send(client, 251.0, path)
        bench.wait_for(lambda: bench.page.state.changes.get(path) == 251e3)
        bench.send(client, 1e300, path)
        bench.wait_for(lambda: " to 1e\\+06 N/m" in bench.page._note.content)
        bench.wait_for(lambda: slider.value == 251.0)
    bench.page._reset()
    bench.wait_for(lambda: "**B** unchanged" in bench.page._table.content)
    assert slider.value == 250.0


def test_frames_are_sent_to_an_open_page(bench):
    before = bench.page.stage.frames
    with bench.client() as client:
        received(client)
        bench.wait_for(lambda: bench.page.stage.frames > before + 10)


def test_a_mode_is_shown_and_absurd_choices_are_not(bench):
    view, stage = bench.page.view, bench.page.stage
    with bench.client() as client:
        received(client)
        bench.set(client, view.kind, "modes, dampers stuck")
        bench.wait_for(lambda: view.modes and view.mode.value in view.mode.options)
        assert "body heave" in view.mode.value or "body pitch" in view.mode.value
        bench.set(client, view.mode, view.mode.options[2])
        bench.wait_for(lambda: stage.slower == CYCLE * view.modes[2].frequency)
        for handle, value in ((view.mode, "no mode"), (view.kind, "x" * 1000)):
            bench.set(client, handle, value)
            bench.wait_for(lambda: "must be" in bench.page._note.content)
            bench.page._say("")
        for size in (float("nan"), 1e300):
            bench.set(client, view.amplitude, size)
        bench.set(client, view.kind, RUN)
        bench.wait_for(lambda: not view.modes)
        bench.set(client, view.slower, float("nan"))
        before = stage.frames
        bench.wait_for(lambda: stage.frames > before + 10)
        bench.follows(client, 95.0)


def test_bad_ports_are_refused():
    for port in (0, 80, 70000):
        with pytest.raises(ConfigurationError, match=f"--port {port}: must be 1024 to 65535"):
            open_server(Guard(), port)
