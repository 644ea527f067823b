"use strict";
// Moving modes: u(t) = Re(shape exp(i phase)), points and lines in a canvas. Frame: x to the rear, y right, z up.
(() => {
  const data = JSON.parse(document.getElementById("mode-data").textContent);
  const byId = (id) => document.getElementById(`mode-${id}`);
  const canvas = byId("canvas"), pickCar = byId("car"), pickState = byId("state"), pickMode = byId("pick");
  const amplitude = byId("amplitude"), speed = byId("speed"), play = byId("play"), gallery = byId("gallery");
  const WORDS = { stuck: "dampers stick", sliding: "dampers slide (viscous part alone)" };
  const GHOST = "#c3cad2", GROUND = "#9aa4ae", TURN = 2 * Math.PI;
  let [azimuth, elevation] = wireframe.VIEWS.corner, zoom = 1, phase = 0, playing = true, seen = true, last = 0;

  for (const car of data.cars) {
    const n = car.points.length / 3;
    wireframe.measure(car);
    for (const mode of Object.values(car.states).flat()) {
      mode.reach = Array.from({ length: n }, (_, i) => Math.sqrt([0, 1, 2].reduce(
        (sum, axis) => sum + mode.re[3 * i + axis] ** 2 + mode.im[3 * i + axis] ** 2, 0)) / data.full);
    }
  }
  const car = () => data.cars[Number(pickCar.value)];
  const modes = () => car().states[pickState.value];
  const mode = () => modes()[Number(pickMode.value)];

  function draw(canvas, car, mode, phase, fine) {
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width || !height) return;
    if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
    if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.lineCap = "round";
    const factor = Number(amplitude.value) / data.full, cos = Math.cos(phase), sin = Math.sin(phase);
    const moved = mode.re.map((value, i) => factor * (value * cos - mode.im[i] * sin));
    const view = [azimuth, elevation, zoom];
    const rest = wireframe.project(car, view, width, height, null), now = wireframe.project(car, view, width, height, moved);
    const line = (places, i) => {
      pen.beginPath();
      pen.moveTo(places[car.lines[2 * i]][0], places[car.lines[2 * i]][1]);
      pen.lineTo(places[car.lines[2 * i + 1]][0], places[car.lines[2 * i + 1]][1]);
      pen.stroke();
    };
    pen.strokeStyle = GHOST;
    pen.lineWidth = fine ? 0.8 : 0.5;
    car.groups.forEach((group, i) => { if (data.groups[group] !== "ground") line(rest, i); });
    const depth = (i) => now[car.lines[2 * i]][2] + now[car.lines[2 * i + 1]][2];
    const order = car.groups.map((_, i) => i).sort((i, j) => depth(i) - depth(j));
    for (const i of order) {
      const group = data.groups[car.groups[i]];
      const reach = (mode.reach[car.lines[2 * i]] + mode.reach[car.lines[2 * i + 1]]) / 2;
      pen.strokeStyle = group === "ground" ? GROUND : data.shades[Math.round(reach * (data.shades.length - 1))];
      pen.lineWidth = wireframe.WIDTH[group] * (fine ? 1 : 0.5);
      pen.globalAlpha = 0.75 + 0.25 * Math.max(-1, Math.min(1, depth(i) / (2 * car.size)));
      line(now, i);
    }
    pen.globalAlpha = 1;
    if (fine) axes(pen, height);
  }

  function axes(pen, height) {
    const a = azimuth * TURN / 360, e = elevation * TURN / 360, x = 46, y = height - 40;
    const ends = { "x rear": [-Math.sin(a), -Math.sin(e) * Math.cos(a)], "y right": [Math.cos(a), -Math.sin(e) * Math.sin(a)],
      "z up": [0, Math.cos(e)] };
    pen.strokeStyle = pen.fillStyle = "#5a6672";
    pen.lineWidth = 1;
    pen.font = "11px sans-serif";
    pen.textAlign = "center";
    for (const [word, [across, upwards]] of Object.entries(ends)) {
      pen.beginPath(); pen.moveTo(x, y); pen.lineTo(x + 22 * across, y - 22 * upwards); pen.stroke();
      pen.fillText(word, x + 34 * across, y - 32 * upwards + 4);
    }
  }

  function show() {
    const now = mode();
    draw(canvas, car(), now, phase, true);
    const energy = now.energy.map(([name, share]) => `${name} ${share} %`).join(", ");
    byId("words").replaceChildren(
      Object.assign(document.createElement("b"), { textContent: `${now.hz.toFixed(2)} Hz, damping ratio ${(100 * now.zeta).toFixed(1)} %` }),
      document.createElement("br"), `${now.text}.`, document.createElement("br"), `Kinetic energy: ${energy}.`);
  }

  function fill(select, texts) {
    select.replaceChildren(...texts.map(([value, text]) => new Option(text, value)));
  }

  function chooseMode(index) {
    pickMode.value = String(index);
    gallery.querySelectorAll("button").forEach((one, i) => one.setAttribute("aria-pressed", String(i === index)));
    show();
  }

  // Opened on the mode with the largest share of body heave and pitch.
  const ride = () => modes().reduce((first, one, i, all) => (one.ride > all[first].ride ? i : first), 0);

  function chooseState() {
    fill(pickMode, modes().map((one, i) => [i, `${one.hz.toFixed(2)} Hz  ${one.text}`]));
    gallery.replaceChildren(...modes().map((one, i) => {
      const button = document.createElement("button"), picture = document.createElement("canvas");
      button.type = "button";
      button.append(picture, Object.assign(document.createElement("b"), { textContent: `${one.hz.toFixed(2)} Hz` }), one.text);
      button.addEventListener("click", () => chooseMode(i));
      return button;
    }));
    thumbnails();
    chooseMode(ride());
  }

  function thumbnails() {
    const kept = [zoom, azimuth, elevation];
    [zoom, azimuth, elevation] = [1, ...wireframe.VIEWS.corner];
    gallery.querySelectorAll("canvas").forEach((one, i) => draw(one, car(), modes()[i], 0, false));
    [zoom, azimuth, elevation] = kept;
  }

  function chooseCar() {
    const states = Object.keys(car().states);
    fill(pickState, states.map((state) => [state, WORDS[state] || state]));
    chooseState();
  }

  function frame(time) {
    const step = Math.min(time - last, 100) / 1000;
    last = time;
    if (playing && seen) {
      phase = (phase + TURN * Number(speed.value) * step) % TURN;
      draw(canvas, car(), mode(), phase, true);
    }
    requestAnimationFrame(frame);
  }

  function setPlaying(on) {
    playing = on;
    play.textContent = on ? "Pause" : "Play";
  }

  let held = null;
  canvas.addEventListener("pointerdown", (event) => {
    held = [event.clientX, event.clientY, azimuth, elevation];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!held) return;
    azimuth = held[2] - 0.4 * (event.clientX - held[0]);
    elevation = Math.max(-89, Math.min(89, held[3] + 0.4 * (event.clientY - held[1])));
    show();
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { held = null; });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom = Math.max(0.4, Math.min(8, zoom * Math.exp(-0.0015 * event.deltaY)));
    show();
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const turns = { ArrowLeft: [6, 0], ArrowRight: [-6, 0], ArrowUp: [0, 6], ArrowDown: [0, -6] };
    if (event.key === "+" || event.key === "-") zoom *= event.key === "+" ? 1.15 : 1 / 1.15;
    else if (turns[event.key]) {
      azimuth += turns[event.key][0];
      elevation = Math.max(-89, Math.min(89, elevation + turns[event.key][1]));
    } else return;
    event.preventDefault();
    show();
  });
  document.querySelectorAll("[data-view]").forEach((button) => button.addEventListener("click", () => {
    [azimuth, elevation] = wireframe.VIEWS[button.dataset.view];
    zoom = 1;
    show();
  }));
  pickCar.addEventListener("change", chooseCar);
  pickState.addEventListener("change", chooseState);
  pickMode.addEventListener("change", () => chooseMode(Number(pickMode.value)));
  amplitude.addEventListener("input", () => { show(); thumbnails(); });
  play.addEventListener("click", () => setPlaying(!playing));
  window.addEventListener("resize", () => { thumbnails(); show(); });
  window.addEventListener("beforeprint", () => { phase = 0; show(); thumbnails(); });
  gallery.closest("details").addEventListener("toggle", thumbnails);
  new IntersectionObserver((entries) => { seen = entries[0].isIntersecting; }).observe(canvas);
  byId("scale").style.background = `linear-gradient(90deg, ${data.shades.join(", ")})`;
  fill(pickCar, data.cars.map((one, i) => [i, one.name]));
  pickCar.parentElement.hidden = data.cars.length < 2;
  setPlaying(!window.matchMedia("(prefers-reduced-motion: reduce)").matches);
  chooseCar();
  requestAnimationFrame(frame);
})();
