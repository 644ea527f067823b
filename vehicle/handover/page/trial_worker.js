"use strict";
// Tasks of the trial in a worker. The WebAssembly module (vehicle/handover/fmu/runtime/web_*.c) runs the car and computes
// all numbers; here are its memory, the cars and plates of settings, and the order of the calls.

// Samples of a window and of a period; realisations, and periods before the evaluated one: a lightly damped mode of 3 Hz
// on the shaker takes 12 s to settle, a car on rolling tyres has none. Range of the FRF [Hz]. Length of the moving picture
// and time between two of its positions [s].
const LINES = 4096, REALISATIONS = 4, SETTLING = { plates: 3, road: 2 }, LOWEST = 1, HIGHEST = 50, PICTURE = 6, POSITION = 0.01;
// Samples of a period of levels, as web_levels.c, and accuracy of its forces, as `periodic_forces` of the program.
const LEVEL_SAMPLES = 128, LEVEL_TOLERANCE = 1e-7;

// Bytes from base 85, which packed_numbers.py writes, and deflate.
const DIGITS = new Uint8Array(128);
[..."0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%&()*+-;,=>?@^_`{|}~"].forEach((letter, k) => { DIGITS[letter.charCodeAt(0)] = k; });
async function bytesOf(text) {
  const packed = new DataView(new ArrayBuffer(4 * Math.ceil(text.length / 5)));
  for (let at = 0; at < text.length; at += 5) {
    let value = 0;
    for (let k = at; k < at + 5; k++) value = 85 * value + (k < text.length ? DIGITS[text.charCodeAt(k)] : 84);
    packed.setUint32(at / 5 * 4, value);
  }
  const stream = new Blob([packed.buffer.slice(0, Math.floor(text.length * 4 / 5))]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Figures of the catalogue: histories of a figure from those of its channels, and their reductions to a number; the same
// names and definitions as in vehicle/runs/figures/rows.py and reductions.py.
const over = (change) => (histories, { statics }) => histories.map((history, k) => history.map((value) => change(value, statics[k])));
const travel = (step) => (history) => { let sum = 0; return history.map((v, k) => k ? (sum += 0.5 * step * (v + history[k - 1])) : 0); };
const ROWS = {
  channels: (histories) => histories,
  velocities: (histories) => histories,
  loads: over((force, load) => force / load),
  load_variations: over((force, load) => force / load - 1),
  load_forces: over((force, load) => force - load),
  travels: (histories, _, step) => histories.map(travel(step)),
};
const square = (row) => row.reduce((sum, value) => sum + value * value, 0) / row.length;
const most = (row) => row.reduce((high, value) => Math.max(high, Math.abs(value)), 0);
const ends = (row) => row.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
const total = (rows) => rows.reduce((sum, row) => sum + square(row), 0);
const REDUCTIONS = {
  rms: (rows) => Math.sqrt(total(rows)),
  wheel_rms: (rows) => Math.sqrt(total(rows) / rows.length),
  peak: (rows) => Math.max(...rows.map(most)),
  peak_to_peak: (rows) => Math.max(...rows.map(ends).map(([low, high]) => high - low)),
  lowest: (rows) => Math.min(...rows.map((row) => ends(row)[0])),
  largest_crest: (rows) => Math.max(...rows.map((row) => most(row) / Math.sqrt(square(row)))),
};

class Trial {
  static async open(data) {
    const { instance } = await WebAssembly.instantiate(await bytesOf(data.module), {});
    const trial = new Trial(data, instance.exports);
    trial.tracks = await Promise.all(data.tracks.map(async ({ step, order, changes }) => trial.at(await bytesOf(changes), (place, count) =>
      trial.module.open_track(place, count / 2, order, step))));
    return trial;
  }

  constructor(data, module) {
    Object.assign(this, { data, module, cars: [], tables: new Map(), transforms: new Map(), cancelled: false });
    module._initialize();
    const { ahead, plateCount, samples, interval } = data, most = Math.max(samples, (SETTLING.plates + 1) * LINES) + ahead;
    const further = (data.figures ?? []).flatMap((figure) => figure.outputs).length;
    const outputs = Math.max(3 + 2 * data.dampers.length + further, data.motions.length), last = Math.round(HIGHEST * LINES * interval);
    this.places = {
      parameters: module.reserve(8 * (data.parameters.flat().length + 1)),
      plates: module.reserve(8 * 2 * plateCount * most),
      outputs: module.reserve(4 * outputs),
      values: module.reserve(8 * outputs * most),
      accelerations: module.reserve(8 * 3 * most),
      derived: data.figures ? module.reserve(8 * most) : 0,
      results: module.reserve(8 * Math.max(LINES, 4 * last)),
      derivative: this.at(Float64Array.from(data.derivative)),
      weightings: data.weightings.map((sections) => this.at(Float64Array.from(sections.flat()))),
    };
    this.sine = module.open_sine(this.transform(LINES), last, interval);
  }

  // Place of a copy of an array in the memory of the module, or what `use` makes of it and of the number of its elements.
  at(array, use = (place) => place) {
    const place = this.module.reserve(array.byteLength);
    new array.constructor(this.module.memory.buffer, place, array.length).set(array);
    return use(place, array.length);
  }

  numbers(place, count) {
    return new Float64Array(this.module.memory.buffer, place, count).slice();
  }

  transform(least) {
    if (!this.transforms.has(least)) this.transforms.set(least, this.module.open_transform(least));
    return this.transforms.get(least);
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
      const { text, runs } = data.cars[place], bytes = await bytesOf(text);
      const planes = this.at(bytes), table = this.at(Int32Array.from(runs.flat()));
      this.cars[place] = module.open_car(planes, table, runs.length);
      if (!this.cars[place]) throw new Error("the numbers of the car are damaged");
    }
    this.car = this.cars[place];
    if (!this.tables.has(this.ratio)) this.tables.set(this.ratio, this.platesAt(this.ratio));
    Object.assign(this, this.tables.get(this.ratio));
    this.skip = Math.round(data.skip / this.ratio);
  }

  // Table (z, z') of all plates, sample by sample, at a ratio of the speed, and its samples: the record ends with the road.
  platesAt(ratio) {
    const { interval, ahead, plateCount, samples, wheels } = this.data, count = Math.min(Math.floor((samples - 1) / ratio + 1e-9) + 1, samples);
    const plates = this.module.reserve(8 * 2 * plateCount * (count + ahead));
    for (const [plate, track, behind] of wheels)
      this.module.fill_plate(this.tracks[track], ratio, behind, count, interval, plates + 16 * plate, 2 * plateCount);
    return { plates, count };
  }

  // Run the car from rest over a number of samples of plates; returns the places of the histories of outputs.
  run(settings, plates, samples, outputs) {
    const { module, places, data } = this, { buffer } = module.memory;
    new Float64Array(buffer, places.parameters).set([...this.parametersOf(settings), plates === places.plates ? 1 : settings.level]);
    new Int32Array(buffer, places.outputs).set(outputs);
    const done = module.run_car(this.car, places.parameters, plates, samples, data.interval, places.outputs, outputs.length, places.values);
    if (done < samples) throw new Error(`at ${(data.interval * done).toPrecision(3)} s the motion of the car is no longer finite`);
    return outputs.map((_, k) => places.values + 8 * k * samples);
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
    const asked = performance.now();
    await this.choose(settings);
    const { data, module, places, skip } = this, { interval, ahead, weightings } = data, samples = this.count, evaluated = samples - 1 - skip;
    const outputs = [...data.positions, ...data.dampers.flatMap(({ velocity, force }) => [velocity, force]), ...(data.figures ?? []).flatMap((figure) => figure.outputs)], started = performance.now();
    const histories = this.run(settings, this.plates, samples + ahead, outputs), marched = performance.now();
    // Notices on quantities that left their valid range.
    const notices = data.notices.filter((_, k) => module.left(this.car, k));
    const accelerations = [0, 1, 2].map((axis) => places.accelerations + 8 * axis * samples), [x, , z] = accelerations;
    accelerations.forEach((place, axis) => module.differentiate(histories[axis], samples + ahead, interval, places.derivative, place));
    // x and y have one weighting; a transform has two records.
    const transform = this.transform(samples + Math.ceil(data.decay / interval));
    [[x, 2, 0], [z, 1, 2]].forEach(([place, records, axis]) => module.weighted_rms(transform, place, records, samples, skip, interval,
      places.weightings[axis], weightings[axis].length, places.results + 8 * axis));
    const axes = Array.from(this.numbers(places.results, 3));
    module.density_of(this.transform(LINES), z + 8 * skip, evaluated, interval, places.results);
    const comfort = Math.hypot(...axes.map((value, axis) => value * data.factors[axis]));
    const density = this.numbers(places.results, LINES / 2 + 1);
    const pairs = data.dampers.map((_, i) => histories.slice(3 + 2 * i, 5 + 2 * i));
    return {
      axes, notices, skip,
      acceleration: accelerations.map((place) => this.numbers(place, samples)),
      dampers: pairs.map(([velocity, force]) => ({ velocity: this.numbers(velocity, samples), force: this.numbers(force, samples) })),
      slips: pairs.map(([velocity], i) => module.share_above(velocity + 8 * skip, evaluated, data.dampers[i].slip)),
      highest: pairs.map(([, force]) => module.largest_magnitude(force + 8 * skip, evaluated)),
      comfort, density,
      figures: this.figures(histories.slice(3 + 2 * data.dampers.length), samples, comfort, axes),
      resolution: 1 / (LINES * interval),
      seconds: interval * (samples - 1),
      milliseconds: { stepping: marched - started, all: performance.now() - asked },
    };
  }

  // Values of the figures that were asked for, from the places of the histories of their outputs.
  figures(histories, samples, comfort, axes) {
    const { data, module, places: { derivative, derived: rate }, skip } = this, { interval, ahead } = data;
    let next = 0;
    return (data.figures ?? []).map((figure) => {
      if (figure.reduction === "comfort") return figure.axis < 0 ? comfort : axes[figure.axis];
      const read = figure.derived.map((derived) => {
        const place = histories[next++];
        if (!derived) return this.numbers(place, samples);
        module.differentiate(place, samples + ahead, interval, derivative, rate);
        return this.numbers(rate, samples);
      });
      return REDUCTIONS[figure.reduction](ROWS[figure.rows](read, figure, interval).map((row) => row.subarray(skip, samples - 1)));
    });
  }

  // Displacements of the moving picture and of the plates, from the begin of the evaluation on, every POSITION seconds.
  async motion(settings) {
    await this.choose(settings);
    const { data, skip, plates, module } = this, { interval, plateCount, motions, picture, ahead } = data, every = Math.round(POSITION / interval);
    const samples = Math.min(skip + Math.round(PICTURE / interval) + 1, this.count + ahead);
    const histories = this.run(settings, plates, samples, motions), count = Math.floor((samples - 1 - skip) / every) + 1;
    const taken = (place, distance, level) => {
      const values = new Float64Array(module.memory.buffer, place);
      return Float32Array.from({ length: count }, (_, k) => level * values[distance * (skip + every * k)]);
    };
    this.shapes ??= new Int8Array((await bytesOf(picture.shapes)).buffer);
    return {
      motions: histories.map((history) => taken(history, 1, 1)),
      plates: picture.plates.map((plate) => taken(plates + 16 * plate, 2 * plateCount, settings.level)),
      position: POSITION, shapes: this.shapes.slice(),
    };
  }

  // FRF of the seat rail, vertical, to the excited plate or to the height of the road under the foremost wheels, with equal
  // tracks: multisines of random phase with the density of the record, after periods to settle. Mean over realisations, and
  // its standard error. Nothing if a later message cancels it.
  async response(settings) {
    await this.choose(settings);
    this.cancelled = false;
    const { data, module, places, sine, ratio } = this, { interval, plateCount, excited, wheels, ahead } = data, resolution = 1 / (LINES * interval);
    const before = LINES * (data.road ? SETTLING.road : SETTLING.plates), samples = before + LINES + ahead, last = Math.round(HIGHEST / resolution);
    module.begin_response(sine, this.plates + 16 * (plateCount * this.skip + excited), this.count - 1 - this.skip, 2 * plateCount, settings.level);
    let seed = 12345;
    for (let realisation = 0; realisation < REALISATIONS; realisation++) {
      await new Promise((done) => setTimeout(done));
      if (this.cancelled) return null;
      seed = module.draw_phases(sine, seed);
      new Float64Array(module.memory.buffer, places.plates, 2 * plateCount * samples).fill(0);
      for (const [plate, , behind] of wheels) module.excite(sine, behind * interval / ratio, places.plates + 16 * plate, samples, 2 * plateCount);
      const [position] = this.run(settings, places.plates, samples, [data.positions[2]]);
      module.differentiate(position, samples, interval, places.derivative, places.accelerations);
      module.add_response(sine, places.accelerations + 8 * before);
    }
    module.mean_response(sine, places.results);
    const first = Math.ceil(LOWEST / resolution), lines = Array.from({ length: last + 1 - first }, (_, k) => (first + k) * resolution);
    const [re, im, magnitude, error] = [0, 1, 2, 3].map((row) => this.numbers(places.results + 8 * (last * row + first - 1), lines.length));
    return { frequency: lines, re, im, magnitude, error };
  }

  // First harmonic of the seat rail over the level of all plates, and the level at which each damper lets go while the
  // others stick. Nothing for another stiffness or speed than that of the run, or if a later message cancels it.
  async levels(settings) {
    this.cancelled = false;
    const { data, module } = this, { numbers, laws, frequency, level } = data.levels, columns = 1 + laws.length, count = level.length;
    if (data.sliders.some(({ id, values, value }) => values && settings[id] !== value)) return null;
    this.plant ??= {
      car: module.open_levels(this.at(new Float64Array((await bytesOf(numbers)).buffer)), this.transform(LEVEL_SAMPLES)),
      curves: laws.map(({ curve }) => this.at(Float64Array.from(curve))),
      level: this.at(Float64Array.from(level)),
      value: module.reserve(8 * (count * columns + laws.length)),
    };
    const { car, curves, level: place, value } = this.plant, parameters = this.parametersOf(settings), size = new Float64Array(frequency.length * count);
    const of = (damper, name) => parameters[data.names.length * damper + data.names.indexOf(name)], first = laws.map(() => new Float64Array(frequency.length));
    laws.forEach(({ curve, viscous, full }, i) => module.set_law(car, i, curves[i], (curve.length - 1) / 2, of(i, "curve_scale"), viscous, of(i, "coulomb_friction"), full));
    for (let k = 0; k < frequency.length; k++) {
      await new Promise((done) => setTimeout(done));
      if (this.cancelled) return null;
      module.level_line(car, frequency[k], place, count, LEVEL_TOLERANCE, value);
      const values = this.numbers(value, count * columns + laws.length);
      for (let m = 0; m < count; m++) size[k * count + m] = values[m * columns];
      first.forEach((line, i) => { line[k] = values[count * columns + i]; });
    }
    return { size, first };
  }
}

// Buffers of all arrays in a result, which a message moves without a copy.
const buffersOf = (value) => (ArrayBuffer.isView(value) ? [value.buffer] : value && typeof value === "object" ? Object.values(value).flatMap(buffersOf) : []);

if (typeof WorkerGlobalScope !== "undefined") {
  let trial;
  onmessage = async ({ data: { data, id, task, settings } }) => {
    try {
      trial ??= Trial.open(data);
      const opened = await trial;
      if (task === "cancel") opened.cancelled = true;
      else {
        const result = task && await opened[task](settings);
        postMessage({ id, task, settings, result }, buffersOf(result));
      }
    } catch (error) {
      postMessage({ id, task, settings, error: error.message });
    }
  };
}
