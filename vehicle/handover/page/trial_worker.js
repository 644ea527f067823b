"use strict";
// Numbers of the trial, computed in a worker after trial_signals.js: the runs of the car are the C runtime of FMUs as
// WebAssembly; here are cars, plates, records, motions and FRFs.

// Samples of a window and of a period; realisations, and periods before the evaluated one: a lightly damped mode of 3 Hz
// on the shaker takes 12 s to settle, a car on rolling tyres has none. Range of the FRF [Hz]. Length of the moving picture
// and time between two of its positions [s].
const LINES = 4096, REALISATIONS = 4, SETTLING = { plates: 3, road: 2 }, LOWEST = 1, HIGHEST = 50, PICTURE = 6, POSITION = 0.01;

class Trial {
  static async open(data) {
    const { instance } = await WebAssembly.instantiate(await bytesOf(data.module), {});
    const tracks = await Promise.all(data.tracks.map(async ({ step, order, changes }) =>
      Float64Array.from(integersOf(await bytesOf(changes), order), (value) => step * value)));
    return new Trial(data, instance.exports, tracks);
  }

  constructor(data, module, tracks) {
    Object.assign(this, { data, module, tracks, cars: [], tables: new Map(), cancelled: false });
    module._initialize();
    const { ahead, plateCount, samples } = data, most = Math.max(samples, (SETTLING.plates + 1) * LINES) + ahead;
    const outputs = Math.max(3 + 2 * data.dampers.length, data.motions.length);
    this.places = {
      parameters: module.reserve(8 * data.parameters.flat().length),
      plates: module.reserve(8 * 2 * plateCount * most),
      outputs: module.reserve(4 * outputs),
      values: module.reserve(8 * outputs * most),
    };
  }

  // Take the car and the plates of settings: sliders with fixed positions change one at a time.
  async choose(settings) {
    const { data, module } = this, moved = data.sliders.filter(({ id, values, value }) => values && settings[id] !== value);
    if (moved.length > 1) throw new Error(`${moved.map(({ words }) => words).join(" and ")} can change one at a time only`);
    let place = 0;
    this.ratio = 1;
    for (const { id, words, values, cars, ratios } of moved) {
      const k = values.indexOf(settings[id]);
      if (k < 0) throw new Error(`${words}: found ${settings[id]}, must be ${values.join(", ")}`);
      [place, this.ratio] = [cars[k], ratios[k]];
    }
    if (!this.cars[place]) {
      const content = wordsOf(await bytesOf(data.cars[place].text), data.cars[place].runs), at = module.reserve(content.length);
      new Uint8Array(module.memory.buffer, at, content.length).set(content);
      this.cars[place] = module.open_car(at, content.length);
      if (!this.cars[place]) throw new Error("the numbers of the car are damaged");
    }
    this.car = this.cars[place];
    if (!this.tables.has(this.ratio)) this.tables.set(this.ratio, this.platesAt(this.ratio));
    this.plates = this.tables.get(this.ratio);
    this.skip = Math.round(data.skip / this.ratio);
  }

  // Table (z, z') of all plates, sample by sample, at a ratio of the speed: the record ends with the road.
  platesAt(ratio) {
    const { interval, ahead, plateCount, samples, wheels } = this.data, count = Math.min(Math.floor((samples - 1) / ratio + 1e-9) + 1, samples);
    const plates = new Float64Array(2 * plateCount * (count + ahead));
    for (const [plate, track, behind] of wheels) {
      const table = plateTable(heightsAt(this.tracks[track], ratio, behind, count), interval, ahead);
      for (let i = 0; i < count + ahead; i++) plates.set(table.subarray(2 * i, 2 * i + 2), 2 * (i * plateCount + plate));
    }
    return plates;
  }

  // Histories of outputs, one array each: the car from rest over plates, (z, z') of all plates sample by sample.
  run(parameters, plates, outputs) {
    const { module, places, data } = this, samples = plates.length / (2 * data.plateCount), buffer = module.memory.buffer;
    new Float64Array(buffer, places.parameters, parameters.length).set(parameters);
    new Float64Array(buffer, places.plates, plates.length).set(plates);
    new Int32Array(buffer, places.outputs, outputs.length).set(outputs);
    const done = module.run_car(this.car, places.parameters, places.plates, samples, data.interval, places.outputs, outputs.length, places.values);
    if (done < samples) throw new Error(`at ${(data.interval * done).toPrecision(3)} s the motion of the car is no longer finite`);
    const values = new Float64Array(module.memory.buffer, places.values, outputs.length * samples);
    return outputs.map((_, k) => values.slice(k * samples, (k + 1) * samples));
  }

  text(place) {
    const bytes = new Uint8Array(this.module.memory.buffer, place);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
  }

  // Notices of the last run on quantities that left their valid range.
  notices() {
    const places = Array.from({ length: this.module.watched(this.car) }, (_, k) => this.module.notice(this.car, k));
    return places.filter(Boolean).map((place) => this.text(place));
  }

  // Second derivative of a position, with the filter of the records; the last `ahead` samples are lost.
  acceleration(position) {
    const { derivative, ahead, interval } = this.data, n = position.length - ahead, result = new Float64Array(n);
    const start = position[0], moved = new Float64Array(n + 2 * ahead);
    for (let i = 0; i < position.length; i++) moved[i + ahead] = position[i] - start;
    const weights = derivative.map((weight) => weight / interval ** 2);
    for (let i = 0; i < n; i++) {
      let sum = 0;
      for (let k = 0; k < weights.length; k++) sum += weights[k] * moved[i + k];
      result[i] = sum;
    }
    return result;
  }

  parametersOf(settings) {
    const { data } = this, values = data.parameters.map((row) => row.slice());
    for (const slider of data.sliders)
      for (const damper of slider.dampers) values[damper][slider.parameter] = settings[slider.id];
    const [limit, static_limit] = ["coulomb_friction", "static_friction"].map((name) => data.names.indexOf(name));
    for (const row of values) row[static_limit] = Math.max(row[static_limit], row[limit]);
    return values.flat();
  }

  // Record of the car with comfort, densities and dampers.
  async record(settings) {
    await this.choose(settings);
    const { data, skip } = this, { interval } = data, count = data.dampers.length, started = performance.now();
    const outputs = [...data.positions, ...data.dampers.flatMap(({ velocity, force }) => [velocity, force])];
    const histories = this.run(this.parametersOf(settings), this.plates.map((value) => settings.level * value), outputs);
    const marched = performance.now(), notices = this.notices(), acceleration = histories.slice(0, 3).map((position) => this.acceleration(position));
    const samples = acceleration[0].length, [w] = data.weightings;
    const [x, y] = weighted(acceleration[0], acceleration[1], w, interval);
    const [z] = weighted(acceleration[2], null, data.weightings[2], interval);
    const axes = [x, y, z].map((history) => rms(history, skip));
    const dampers = Array.from({ length: count }, (_, i) => ({ velocity: histories[3 + 2 * i].subarray(0, samples), force: histories[4 + 2 * i].subarray(0, samples) }));
    // In typed arrays: as numbers in an object for each damper, Chromium 150 gives all dampers the numbers of the last one
    // when it optimises the loop while it runs.
    const slips = new Float64Array(count), highest = new Float64Array(count);
    for (let i = 0; i < count; i++) {
      const { velocity, force } = dampers[i];
      for (let k = skip; k < samples; k++) {
        if (Math.abs(velocity[k]) > data.dampers[i].slip) slips[i]++;
        highest[i] = Math.max(highest[i], Math.abs(force[k]));
      }
      slips[i] /= samples - skip;
    }
    return {
      acceleration, dampers, slips, highest, axes, notices, skip,
      comfort: Math.hypot(...axes.map((value, axis) => value * data.factors[axis])),
      density: density(acceleration[2], skip, LINES, interval),
      resolution: 1 / (LINES * interval),
      seconds: data.interval * (samples - 1),
      milliseconds: { stepping: marched - started, all: performance.now() - started },
    };
  }

  // Displacements of the moving picture and of the plates, from the begin of the evaluation on, every POSITION seconds.
  async motion(settings) {
    await this.choose(settings);
    const { data, skip, plates } = this, { interval, plateCount, motions, picture } = data, every = Math.round(POSITION / interval);
    const samples = Math.min(skip + Math.round(PICTURE / interval) + 1, plates.length / (2 * plateCount));
    const moving = plates.slice(0, 2 * plateCount * samples).map((value) => settings.level * value);
    const histories = this.run(this.parametersOf(settings), moving, motions), count = Math.floor((samples - 1 - skip) / every) + 1;
    const taken = (of) => Float32Array.from({ length: count }, (_, k) => of(skip + every * k));
    this.shapes ??= new Int8Array((await bytesOf(picture.shapes)).buffer);
    return {
      motions: histories.map((history) => taken((i) => history[i])),
      plates: picture.plates.map((plate) => taken((i) => moving[2 * (i * plateCount + plate)])),
      position: POSITION, shapes: this.shapes,
    };
  }

  // FRF of the seat rail, vertical, to the excited plate or to the height of the road under the foremost wheels, with equal
  // tracks: multisines of random phase with the density of the record, after periods to settle. Mean over realisations, and
  // its standard error. Nothing if a later message cancels it.
  async response(settings) {
    await this.choose(settings);
    this.cancelled = false;
    const { data, ratio } = this, { interval, plateCount, excited, wheels } = data, parameters = this.parametersOf(settings);
    const samples = this.plates.length / (2 * plateCount) - data.ahead, z = Float64Array.from({ length: samples }, (_, i) => this.plates[2 * (i * plateCount + excited)]);
    const periods = (data.road ? SETTLING.road : SETTLING.plates) + 1;
    const levels = density(z, this.skip, LINES, interval), last = Math.round(HIGHEST * LINES * interval);
    const frequency = Array.from({ length: last }, (_, k) => (k + 1) / (LINES * interval));
    const re = new Float64Array(last), im = new Float64Array(last), square = new Float64Array(last);
    let seed = 12345;
    const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;
    for (let realisation = 0; realisation < REALISATIONS; realisation++) {
      await new Promise((done) => setTimeout(done));
      if (this.cancelled) return null;
      const plates = new Float64Array(2 * plateCount * (periods * LINES + data.ahead)), phases = Array.from({ length: last }, () => 2 * Math.PI * random());
      // z = sum 2 size cos(omega (t - delay) + phase): mean square 2 size^2, which is density times resolution.
      const waves = (delay) => {
        const sr = new Float64Array(LINES), si = new Float64Array(LINES), vr = new Float64Array(LINES), vi = new Float64Array(LINES);
        for (let k = 1; k <= last; k++) {
          const omega = 2 * Math.PI * frequency[k - 1], size = settings.level * Math.sqrt(levels[k] / (2 * LINES * interval)), phase = phases[k - 1] - omega * delay;
          sr[k] = sr[LINES - k] = size * Math.cos(phase);
          si[k] = -size * Math.sin(phase); si[LINES - k] = -si[k];
          vr[k] = vr[LINES - k] = -omega * size * Math.sin(phase);
          vi[k] = -omega * size * Math.cos(phase); vi[LINES - k] = -vi[k];
        }
        transform(sr, si);
        transform(vr, vi);
        return [sr, vr];
      };
      for (const [plate, , behind] of wheels) {
        const [height, rate] = waves(behind * interval / ratio);
        for (let i = 0; i < periods * LINES + data.ahead; i++) {
          plates[2 * (i * plateCount + plate)] = height[i % LINES];
          plates[2 * (i * plateCount + plate) + 1] = rate[i % LINES];
        }
      }
      const [position] = this.run(parameters, plates, [data.positions[2]]);
      const response = this.acceleration(position).slice((periods - 1) * LINES), quadrature = new Float64Array(LINES);
      const [input] = waves(0), rest = new Float64Array(LINES);
      transform(response, quadrature);
      transform(input, rest);
      for (let k = 1; k <= last; k++) {
        const power = input[k] ** 2 + rest[k] ** 2;
        const a = (response[k] * input[k] + quadrature[k] * rest[k]) / power, b = (quadrature[k] * input[k] - response[k] * rest[k]) / power;
        re[k - 1] += a / REALISATIONS; im[k - 1] += b / REALISATIONS;
        square[k - 1] += (a * a + b * b) / REALISATIONS;
      }
    }
    const magnitude = re.map((value, k) => Math.hypot(value, im[k]));
    const error = magnitude.map((value, k) => Math.sqrt(Math.max(square[k] - value * value, 0) / (REALISATIONS - 1)));
    const first = Math.ceil(LOWEST * LINES * interval) - 1;
    const [f, x, y, size, deviation] = [frequency, re, im, magnitude, error].map((values) => values.slice(first));
    return { frequency: f, re: x, im: y, magnitude: size, error: deviation };
  }
}

if (typeof WorkerGlobalScope !== "undefined") {
  let trial;
  onmessage = async ({ data: { data, id, task, settings } }) => {
    try {
      trial ??= Trial.open(data);
      const opened = await trial;
      if (task === "cancel") opened.cancelled = true;
      else postMessage({ id, task, settings, result: task && await opened[task](settings) });
    } catch (error) {
      postMessage({ id, task, settings, error: error.message });
    }
  };
}
