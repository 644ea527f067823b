"use strict";
// Moving picture of the trial: the car of the settings in red before the reference in grey, from the displacements of the
// body and the wheels that trial_worker.js returns, on the wireframe of the modes.
const trialPicture = (() => {
  const RED = "#c0392b", GREY = "#8a949e", GROUND = "#5a6672", FRAME = 32, SPEED = 0.5, AIM = 120, FACTORS = [1, 2, 5, 10, 20, 50, 100, 200];
  const byId = (id) => document.getElementById(`trial-${id}`);
  const canvas = byId("picture"), play = byId("play"), factor = byId("factor"), words = byId("factor-words");
  const modes = JSON.parse(document.getElementById("mode-data").textContent), car = modes.cars[0];
  let runs = [], playing = !matchMedia("(prefers-reduced-motion: reduce)").matches, seen = false, time = 0, last = 0, chosen = false;
  wireframe.measure(car);

  // Points of each plate, wheel by wheel: each is drawn with four lines; stands of the body come after them.
  const ground = modes.groups.indexOf("ground");
  const corners = car.groups.flatMap((group, k) => (group === ground ? [[car.lines[2 * k], car.lines[2 * k + 1]]] : []));
  const plates = Array.from({ length: corners.length / 4 }, (_, wheel) => [...new Set(corners.slice(4 * wheel, 4 * wheel + 4).flat())]);

  // Displacements of all points [mm] at a time [s], enlarged.
  function moved({ motions, plates: heights, position, shapes, steps }, time) {
    const size = FACTORS[Number(factor.value)] * 1000, at = Math.min(time / position, motions[0].length - 1.001), k = Math.floor(at), t = at - k;
    const value = (history) => size * ((1 - t) * history[k] + t * history[k + 1]), n = car.points.length, result = new Float64Array(n);
    motions.forEach((history, motion) => {
      const amount = value(history) * steps[motion];
      for (let i = 0; i < n; i++) result[i] += amount * shapes[motion * n + i];
    });
    heights.forEach((history, wheel) => { for (const point of plates[wheel]) result[3 * point + 2] += value(history); });
    return result;
  }

  function draw() {
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width || !height || !runs.length) return;
    if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
    if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.lineCap = "round";
    for (const [run, colour] of runs) {
      const places = wireframe.project(car, [...wireframe.VIEWS.corner, 1], width, height, moved(run, time));
      for (const own of modes.groups.keys()) {
        pen.strokeStyle = own === ground ? GROUND : colour;
        pen.lineWidth = 0.6 * wireframe.WIDTH[modes.groups[own]];
        pen.beginPath();
        car.groups.forEach((group, k) => {
          if (group !== own) return;
          const [from, to] = [places[car.lines[2 * k]], places[car.lines[2 * k + 1]]];
          pen.moveTo(from[0], from[1]); pen.lineTo(to[0], to[1]);
        });
        pen.stroke();
      }
    }
    pen.fillStyle = GROUND;
    pen.font = "12px system-ui, sans-serif";
    pen.fillText(`Displacements ${FACTORS[Number(factor.value)]} times, half speed: ${time.toFixed(1)} s`, 4, 13, width - 8);
  }

  function step(now) {
    if (playing && seen && runs.length && now - last >= FRAME) {
      time += Math.min((now - last) / 1000, 0.1) * SPEED;
      if (time > duration()) time = 0;
      last = now;
      draw();
    }
    requestAnimationFrame(step);
  }
  const duration = () => Math.min(...runs.map(([run]) => (run.motions[0].length - 1) * run.position));

  function label() {
    play.textContent = playing ? "Pause" : "Play";
    words.textContent = `Displacements in the picture: ${FACTORS[Number(factor.value)]} times`;
  }

  play.addEventListener("click", () => { playing = !playing; label(); });
  factor.max = FACTORS.length - 1;
  factor.addEventListener("input", () => { chosen = true; label(); draw(); });
  new IntersectionObserver(([entry]) => { seen = entry.isIntersecting; }).observe(canvas);
  label();
  requestAnimationFrame(step);

  return {
    // Motions of the reference and of the car of the settings; either may be missing.
    show(before, now) {
      runs = [[before, GREY], [now, RED]].filter(([run]) => run);
      if (runs.length && !chosen) {
        // As large as AIM millimetres on the car, the same for both.
        const peak = 1000 * Math.max(...runs[0][0].motions.map((history, k) => (k === 1 || k === 2 ? 0 : Math.max(...history.map(Math.abs)))));
        factor.value = Math.max(0, FACTORS.findLastIndex((size) => size * peak <= AIM));
        label();
      }
      draw();
    },
    get playing() { return playing; },
  };
})();
