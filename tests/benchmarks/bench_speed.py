"""Speed of the bench: processor time of all numbers, and of a frame. `python -m tests.benchmarks.bench_speed`."""

import subprocess
import sys
import time
from statistics import median

from vehicle import read_signal, road
from vehicle.handover.bench.drive import SECONDS, bench_drive
from vehicle.handover.bench.guard import Guard
from vehicle.handover.bench.motion import car_motion, mode_motion
from vehicle.handover.bench.numbers import numbers
from vehicle.runs.car import Car
from vehicle.signals.excitation.input_files import find_input

CLIENT = """
import sys, websockets.sync.client as client, msgspec, viser, time
camera = {"type": "ViewerCameraMessage", "fov": 1.0, "near": 1.0, "far": 1.0, "image_height": 9, "image_width": 9,
          "position": (0, 0, 1.0), "look_at": (0, 0, 1.0), "up_direction": (0, 0, 1.0), "wxyz": (1.0, 0, 0, 0)}
with client.connect(sys.argv[1], origin=sys.argv[2], subprotocols=["viser-v" + viser.__version__], max_size=None,
                    proxy=None) as page:
    page.send(msgspec.msgpack.encode(camera))
    while True:
        page.recv()
"""
"""Program of a window that reads all frames."""


def numbers_ms(name: str, *, on_road: bool, seconds: float = SECONDS, repeats: int = 9) -> float:
    """Return the median processor time [ms] of all numbers after a change of the damping of the front dampers.

    Args:
        name: name of the car.
        on_road: class C at 80 km/h, else high.csv.
        seconds: length of the evaluated excerpt [s].
        repeats: number of changes.
    """
    car = Car.load(name)
    source = road("C", 80) if on_road else read_signal(find_input("high.csv"), wheel=car.vehicle.shaker_wheel)
    drive = bench_drive(car, source, seconds=seconds)
    car = car.with_(drive.overrides) if drive.overrides else car
    times = []
    for index in range(repeats + 2):
        variant, started = car.with_({"front.damper.viscous": 2000.0 + 10.0 * index}), time.thread_time()
        numbers(variant, drive)
        times.append(1e3 * (time.thread_time() - started))
    return median(times[2:])


def frame_ms(name: str = "focus", picture: str = "run", seconds: float = 4.0) -> tuple[float, float]:
    """Return frames a second, and processor time of a frame [ms], all threads, with one window in another process.

    Args:
        name: name of the car.
        picture: "run" on high.csv, "mode", or "obstacle": a run over a cleat.
        seconds: length of the measurement [s].
    """
    from vehicle.handover.bench.server import close_server, open_server
    from vehicle.handover.bench.stage import CYCLE, Stage

    car, guard = Car.load(name), Guard()
    high = read_signal(find_input("high.csv"), wheel=car.vehicle.shaker_wheel)
    drive = bench_drive(car, road("cleat:20x50", 30) if picture == "obstacle" else high)
    car = car.with_(drive.overrides) if drive.overrides else car
    server = open_server(guard, 8800)
    stage = Stage(server, car, drive)
    mode = car.modes("stuck")[0]
    motion = mode_motion(stage.car_scene.wire, mode.shape, mode.frequency)
    stage.show(car, motion if picture == "mode" else car_motion(car, drive), slower=CYCLE * mode.frequency)
    origin = f"http://127.0.0.1:{server.get_port()}"
    address = f"ws{origin.removeprefix('http')}/{guard.token}"
    window = subprocess.Popen([sys.executable, "-c", CLIENT, address, origin])
    try:
        until = time.monotonic() + 30.0
        while not stage.frames and time.monotonic() < until:
            time.sleep(0.05)
        time.sleep(0.5)
        frames, began, started = stage.frames, time.monotonic(), time.process_time()
        time.sleep(seconds)
        sent = stage.frames - frames
        return sent / (time.monotonic() - began), 1e3 * (time.process_time() - started) / max(sent, 1)
    finally:
        window.kill()
        window.wait()
        stage.stop()
        close_server(server)


def main() -> None:
    """Print the times."""
    for name, on_road in (("focus", False), ("focus_road", True)):
        print(f"{name}: {numbers_ms(name, on_road=on_road):.0f} ms processor time to all numbers of {SECONDS:g} s")
    for name, picture in (("focus", "run"), ("focus", "mode"), ("focus_road", "obstacle")):
        rate, cost = frame_ms(name, picture)
        print(f"{name}, {picture}: {rate:.1f} frames a second to one window, {cost:.1f} ms processor time each")


if __name__ == "__main__":
    main()
