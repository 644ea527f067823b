"use strict";
// Section "Try it": sliders, sentence, plots and table. The numbers come from trial_worker.js in a worker. A: the car with
// the settings of the sliders, red; B: the reference, grey.
(() => {
  const data = JSON.parse(document.getElementById("trial-data").textContent);
  const byId = (id) => document.getElementById(`trial-${id}`);
  const RED = "#c0392b", GREY = "#8a949e", BAND = "rgba(192, 57, 43, .18)", LINE = "#d5dae0", INK = "#5a6672";
  const CLASSES = "ABCDEFGH", PAUSE = 250, SECONDS = 3;
  const source = URL.createObjectURL(new Blob([byId("worker").textContent], { type: "text/javascript" }));
  const worker = new Worker(source);
  const start = Object.fromEntries(data.sliders.map((slider) => [slider.id, slider.value]));
  const inputs = new Map();
  let settings = { ...start }, now = null, before = null, busy = null, waiting = null, timer = 0;

  const short = (value, digits = 3) => String(Number(value.toPrecision(digits)));
  const classOf = (level) => {
    const place = CLASSES.indexOf(data.roadClass) + Math.round(Math.log2(level));
    return CLASSES[place] ?? `${short(level)} times ${data.roadClass}`;
  };
  const words = (slider, value) => (slider.id === "level" && data.roadClass ? `class ${classOf(value)} (heights times ${short(value)})` : `${short(value)} ${slider.unit}`.trim());
  // A class of ISO 8608 has four times the density of the one before, so the slider of a road moves by factors of two.
  // A slider with fixed positions moves over their indices.
  const toSlider = (slider, value) => (slider.values ? slider.values.indexOf(value) : slider.id === "level" ? Math.log2(value) : value);
  const fromSlider = (slider, value) => (slider.values ? slider.values[value] : slider.id === "level" ? 2 ** value : value);
  const rangeOf = (slider) => (slider.values ? [0, slider.values.length - 1] : [slider.low, slider.high].map((x) => toSlider(slider, x)));
  const stepOf = (slider) => (slider.values || (slider.id === "level" && data.roadClass) ? 1 : slider.id === "level" ? 0.05 : "any");

  function controls() {
    const box = byId("controls");
    for (const slider of data.sliders) {
      const label = document.createElement("label"), input = document.createElement("input");
      input.type = "range";
      input.id = label.htmlFor = `trial-${slider.id}`;
      [input.min, input.max] = rangeOf(slider);
      input.step = stepOf(slider);
      // Each fixed position is a car of its own, so these sliders change one at a time.
      input.addEventListener("input", () => {
        const others = slider.values ? data.sliders.filter(({ id, values }) => values && id !== slider.id) : [];
        const back = Object.fromEntries(others.map(({ id }) => [id, start[id]]));
        move({ ...settings, ...back, [slider.id]: fromSlider(slider, Number(input.value)) });
      });
      inputs.set(slider.id, [slider, input, label]);
      box.append(label, input);
    }
    place();
    box.append(button("Back to the car of the run", () => move(start)), button("Keep as A", () => {
      if (!now) return;
      before = now;
      show();
    }));
  }

  function button(text, action) {
    const element = Object.assign(document.createElement("button"), { type: "button", textContent: text });
    element.addEventListener("click", action);
    return element;
  }

  // Static friction acts as at least the Coulomb friction of its dampers.
  function acting(slider, settings) {
    const below = data.names[slider.parameter] === "static_friction" ? settings[slider.id.replace("static", "coulomb")] : -Infinity;
    return Math.max(settings[slider.id], below);
  }

  function place() {
    for (const [slider, input, label] of inputs.values()) {
      if (Number(input.value) !== toSlider(slider, settings[slider.id])) input.value = toSlider(slider, settings[slider.id]);
      label.textContent = `${slider.words}: ${words(slider, acting(slider, settings))}`;
    }
  }

  function move(values) {
    settings = { ...values };
    place();
    request("record");
  }

  // One task at a time: while the worker computes, only the latest settings wait. FRFs give way to records.
  function request(task) {
    clearTimeout(timer);
    if (busy) {
      waiting = task;
      if (busy === "response" || busy === "levels") worker.postMessage({ task: "cancel" });
      return;
    }
    busy = task;
    waiting = null;
    worker.postMessage({ data: now ? undefined : data, task, settings });
  }

  worker.onmessage = ({ data: { task, settings: asked, result, error } }) => {
    busy = null;
    if (error) {
      byId("words").textContent = `These settings cannot be run: ${error}.`;
    } else if (task === "record") {
      now = { settings: asked, record: result, motion: null, response: null, levels: null };
      before ??= now;
      show();
    } else if (result && same(now.settings, asked)) {
      for (const run of [now, before]) if (same(run.settings, asked)) run[task] = task === "motion" ? { ...result, steps: data.picture.steps } : result;
      show();
    }
    const last = data.levels ? "levels" : null, next = { record: "motion", motion: data.frf ? "response" : last, response: last }[task];
    if (waiting) request(waiting);
    else if (next && !error) timer = setTimeout(() => request(next), task === "record" ? PAUSE : 0);
  };
  worker.onerror = () => { byId("words").textContent = "This browser does not run the car: it blocks workers or WebAssembly."; };

  const same = (a, b) => Object.keys(a).every((key) => a[key] === b[key]);
  const percent = (a, b) => 100 * (a / b - 1);
  const signed = (value, digits) => `${value < 0 ? "−" : "+"}${Math.abs(value).toFixed(digits)}`;
  const difference = (change) => `${signed(change, Math.abs(change) < 10 ? 1 : 0)} %`;

  // A damper slips where it has friction; without, its velocity alone is stated.
  function sentence() {
    const changed = data.sliders.filter((slider) => acting(slider, now.settings) !== acting(slider, before.settings));
    const damper = data.dampers[data.shown], slip = (run) => run.record.slips[data.shown];
    const rubs = data.sliders.some((slider) => data.names[slider.parameter]?.endsWith("friction") && slider.dampers.includes(data.shown) && now.settings[slider.id] > 0);
    const slipping = `the ${damper.name} damper ${rubs ? "slips" : `moves faster than ${short(1000 * damper.slip)} mm/s`} ${short(100 * slip(now), 2)} % of the time`;
    const first = data.shortened ? ` (first ${short(now.record.seconds)} s)` : "";
    if (!changed.length) return `Weighted acceleration of the seat rail${first}; ${slipping}. Move a slider.`;
    const list = changed.map((slider) => `${slider.words} ${words(slider, acting(slider, before.settings))} → ${words(slider, acting(slider, now.settings))}`);
    const change = percent(now.record.comfort, before.record.comfort);
    const effect = Math.abs(change) < 0.05 ? "as before" : `before ${short(before.record.comfort)} m/s² (${difference(change)}, ${change > 0 ? "worse" : "better"})`;
    return `Weighted acceleration of the seat rail, ${effect}; ${slipping}, before ${short(100 * slip(before), 2)} %. Changed: ${list.join(", ")}.`;
  }

  // Rows: text, value of a run, digits, and true for a share, whose change is a difference in points.
  function table() {
    const rows = [["a_v (ISO 2631-1) [m/s²]", (run) => run.record.comfort, 4]];
    ["x", "y", "z"].forEach((axis, k) => rows.push([`a_w ${axis} [m/s²]`, (run) => run.record.axes[k], 4]));
    data.dampers.forEach(({ name }, k) => rows.push([`above ${short(1000 * data.dampers[k].slip)} mm/s, ${name} [%]`, (run) => 100 * run.record.slips[k], 3, true]));
    data.dampers.forEach(({ name }, k) => rows.push([`highest force, ${name} [N]`, (run) => run.record.highest[k], 4]));
    (data.figures ?? []).forEach(({ words, unit }, k) => rows.push([`${words} [${unit}]`, (run) => run.record.figures[k], 4]));
    const row = (name, cells) => {
      const line = document.createElement("tr");
      cells.forEach((text, k) => line.append(Object.assign(document.createElement(name), { textContent: text, className: k ? "number" : "" })));
      return line;
    };
    const head = document.createElement("thead"), body = document.createElement("tbody");
    head.append(row("th", ["seat rail and dampers", "A, before", "B, now", "change"]));
    for (const [text, value, digits, share] of rows) {
      // The table has its size before the first record.
      const [a, b] = now ? [value(before), value(now)] : [NaN, NaN];
      const change = share ? `${signed(b - a, 1)} points` : a ? difference(percent(b, a)) : "–";
      body.append(row("td", now ? [text, short(a, digits), short(b, digits), change] : [text, "–", "–", "–"]));
    }
    byId("table").replaceChildren(head, body);
  }

  // Curves in a canvas: [x, y, colour, width, dashes]; bands: [x, low, high, colour]; paint: draws below them.
  function draw(id, title, curves, axes, bands = [], paint = null) {
    const canvas = byId(id), ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width || !height) return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d"), [left, right, top, bottom] = [52, width - 8, 22, height - 22];
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    const scale = (log) => (log ? (value) => Math.log10(Math.max(value, 1e-30)) : (value) => value);
    const [sx, sy] = [scale(axes.logX), scale(axes.logY)], [x0, x1] = axes.x.map(sx), [y0, y1] = axes.y.map(sy);
    const across = (value) => left + (sx(value) - x0) / (x1 - x0) * (right - left);
    const down = (value) => bottom - (sy(value) - y0) / (y1 - y0) * (bottom - top);
    pen.font = "12px system-ui, sans-serif";
    pen.fillStyle = INK;
    pen.textAlign = "left";
    pen.fillText(title, 4, 13, width - 8);
    pen.strokeStyle = LINE;
    pen.lineWidth = 1;
    pen.textAlign = "center";
    for (const mark of marks(axes.x, axes.logX, [1, 2, 5])) {
      pen.beginPath(); pen.moveTo(across(mark), top); pen.lineTo(across(mark), bottom); pen.stroke();
      pen.fillText(short(mark), across(mark), height - 7);
    }
    pen.textAlign = "right";
    for (const mark of marks(axes.y, axes.logY, [1])) {
      pen.beginPath(); pen.moveTo(left, down(mark)); pen.lineTo(right, down(mark)); pen.stroke();
      pen.fillText(axes.logY ? power(mark) : short(mark), left - 4, down(mark) + 4);
    }
    pen.save();
    pen.beginPath(); pen.rect(left, top, right - left, bottom - top); pen.clip();
    paint?.(pen, across, down);
    for (const [x, low, high, colour] of bands) {
      pen.fillStyle = colour;
      pen.beginPath();
      for (let i = 0; i < x.length; i++) pen.lineTo(across(x[i]), down(low[i]));
      for (let i = x.length - 1; i >= 0; i--) pen.lineTo(across(x[i]), down(high[i]));
      pen.fill();
    }
    pen.lineJoin = "round";
    for (const [x, y, colour, thick, dashes] of curves) {
      pen.strokeStyle = colour;
      pen.setLineDash(dashes ?? []);
      pen.lineWidth = thick;
      pen.beginPath();
      for (let i = 0; i < x.length; i++) pen.lineTo(across(x[i]), down(y[i]));
      pen.stroke();
    }
    pen.restore();
  }

  const power = (mark) => `10${String(Math.round(Math.log10(mark))).replace(/./g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit] ?? "⁻")}`;

  function marks([low, high], log, digits) {
    if (log) {
      const found = [];
      for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power++)
        for (const digit of digits) if (digit * 10 ** power >= low * 0.999 && digit * 10 ** power <= high * 1.001) found.push(digit * 10 ** power);
      return found;
    }
    const rough = (high - low) / 5, size = 10 ** Math.floor(Math.log10(rough)), step = size * [1, 2, 5, 10].find((digit) => digit * size >= rough);
    const found = [];
    for (let k = Math.ceil(low / step); k * step <= high; k++) found.push(k * step);
    return found;
  }

  // Map of the first harmonic of the seat rail over frequency and level, with the levels at which dampers let go.
  function showLevels() {
    const { frequency, level, amplitude } = data.levels, mm = level.map((value) => 1000 * value), ends = (axis) => [axis[0], axis[axis.length - 1]];
    const shown = [[before, GREY, 2.2], [now, RED, 1.4]].filter(([run]) => run.levels), latest = now.levels ?? before.levels, marked = 1000 * amplitude * settings.level;
    if (!latest) return;
    const sizes = latest.size.filter((value) => value > 0).map(Math.log10), low = Math.min(...sizes), span = Math.max(...sizes) - low;
    const half = (axis) => Math.sqrt(axis[1] / axis[0]), [wide, tall] = [half(frequency), half(mm)];
    const paint = (pen, across, down) => frequency.forEach((f, k) => mm.forEach((height, m) => {
      const value = latest.size[k * mm.length + m];
      if (!(value > 0)) return; // a hole: no result
      const share = (Math.log10(value) - low) / span;
      pen.fillStyle = `rgb(${[252, 253, 254].map((light, i) => Math.round(light + share * ([64, 128, 184][i] - light)))})`;
      const [left, top] = [across(f / wide), down(height * tall)];
      pen.fillRect(left, top, across(f * wide) - left + 0.6, down(height / tall) - top + 0.6);
    }));
    const lines = shown.flatMap(([run, colour, thick]) => run.levels.first.map((line) => [frequency, Array.from(line, (value) => 1000 * value), colour, thick]));
    byId("levels-words").textContent = `Map: first harmonic of the seat rail, vertical, from ${short(10 ** low, 2)} (white) to ${short(10 ** (low + span), 2)} m/s² per m (blue); lines: a damper lets go; dashed: amplitude of this record.`;
    draw("levels", "Seat rail over amplitude of the plates [mm] and Hz",
      [...lines, [ends(frequency), [marked, marked], INK, 1, [5, 4]]], { x: ends(frequency), y: ends(mm), logX: true, logY: true }, [], paint);
  }

  const both = (of) => [[before, GREY, 2.2], [now, RED, 1.4]].map(([run, colour, thick]) => [...of(run), colour, thick]);

  function show() {
    byId("number").textContent = `${short(now.record.comfort)} m/s²`;
    byId("words").textContent = sentence();
    table();
    const bins = now.record.density.map((_, k) => k * now.record.resolution), first = Math.ceil(1 / now.record.resolution), last = Math.floor(50 / now.record.resolution);
    const cut = (values) => values.slice(first, last + 1), peak = Math.max(...cut(before.record.density), ...cut(now.record.density));
    draw("density", "PSD of the seat rail, vertical [(m/s²)²/Hz] over Hz", both((run) => [cut(bins), cut(run.record.density)]),
      { x: [1, 50], y: [peak * 1e-5, peak * 2], logX: true, logY: true });
    const span = Math.round(1 / data.interval), begin = Math.max(now.record.skip, before.record.skip) + span;
    const time = Array.from({ length: span }, (_, i) => (begin + i) * data.interval);
    const piece = (run) => run.record.acceleration[2].subarray(begin, begin + span), high = 1.1 * Math.max(...piece(before).map(Math.abs), ...piece(now).map(Math.abs));
    draw("time", "Seat rail, vertical [m/s²] over s", both((run) => [time, piece(run)]), { x: [time[0], time[span - 1]], y: [-high, high] });
    const damper = (run) => run.record.dampers[data.shown], part = (values) => values.subarray(begin, begin + SECONDS * span);
    const reach = (of) => Math.max(...part(of(before)).map(Math.abs), ...part(of(now)).map(Math.abs)) * 1.1;
    const [v, f] = [reach((run) => damper(run).velocity), reach((run) => damper(run).force)];
    draw("force", `Force [N] over velocity [m/s] of the ${data.dampers[data.shown].name} damper, ${SECONDS} s`,
      both((run) => [part(damper(run).velocity), part(damper(run).force)]), { x: [-v, v], y: [-f, f] });
    if (data.frf) {
      const runs = [[before, GREY, 2.2], [now, RED, 1.4]].filter(([run]) => run.response), frequency = runs.length ? runs[0][0].response.frequency : [1];
      const top = Math.max(1, ...runs.flatMap(([run]) => Array.from(run.response.magnitude)));
      const bands = now.response ? [[frequency, now.response.magnitude.map((value, k) => value - 2 * now.response.error[k]), now.response.magnitude.map((value, k) => value + 2 * now.response.error[k]), BAND]] : [];
      draw("frf", data.road ? "FRF to the road [m/s² per m] over Hz; band: 2 standard errors" : "FRF [m/s² per m] over Hz; band: 2 standard errors",
        runs.map(([run, colour, thick]) => [run.response.frequency, run.response.magnitude, colour, thick]), { x: [1, 50], y: [top * 1e-3, top * 1.5], logX: true, logY: true }, bands);
    }
    if (data.levels) showLevels();
    trialPicture.show(before.motion, now.motion);
    const { notices } = now.record, more = notices.length > 1 ? `; ${notices.length - 1} more` : "";
    byId("notices").textContent = notices.length ? `Outside the valid range: ${notices[0]}${more}.` : "";
    const { seconds, milliseconds: { stepping, all } } = now.record;
    byId("time-used").textContent = `${short(seconds)} s of the car in ${Math.round(all)} ms, ${Math.round(stepping)} ms of them time steps.`;
  }

  controls();
  table();
  byId("checked").textContent = data.checked;
  window.addEventListener("resize", () => now && show());
  byId("frf").hidden = !data.frf;
  byId("levels").hidden = !data.levels;
  request("record");
})();
