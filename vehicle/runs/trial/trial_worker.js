"use strict";
// Numbers of the trial, computed in a worker: the runs of the car are the C runtime of FMUs as WebAssembly; here are the
// plates between their samples, accelerations, weightings of ISO 2631-1, densities and FRFs.

async function bytesOf(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Integers from their second differences modulo 2^16.
function integersOf(bytes) {
  const values = new Int16Array(bytes.buffer);
  for (let order = 0; order < 2; order++) for (let i = 1; i < values.length; i++) values[i] += values[i - 1];
  return values;
}

// Derivatives of the cubic spline through equally spaced samples, not-a-knot at both ends: a tridiagonal system.
function splineDerivatives(z, interval) {
  const n = z.length - 1, upper = new Float64Array(n + 1), d = new Float64Array(n + 1);
  const slope = (i) => (z[i + 1] - z[i]) / interval;
  upper[0] = 2;
  d[0] = (5 * slope(0) + slope(1)) / 2;
  for (let i = 1; i < n; i++) {
    const pivot = 4 - upper[i - 1];
    upper[i] = 1 / pivot;
    d[i] = (3 * (slope(i - 1) + slope(i)) - d[i - 1]) / pivot;
  }
  d[n] = ((5 * slope(n - 1) + slope(n - 2)) / 2 - 2 * d[n - 1]) / (1 - 2 * upper[n - 1]);
  for (let i = n - 1; i >= 0; i--) d[i] -= upper[i] * d[i + 1];
  return d;
}

// Table (z, z') of a plate at its samples and `ahead` samples more, with constant acceleration after the end.
function plateTable(z, interval, ahead) {
  const n = z.length, d = splineDerivatives(z, interval), table = new Float64Array(2 * (n + ahead));
  const a = (2 * d[n - 2] + 4 * d[n - 1] - 6 * (z[n - 1] - z[n - 2]) / interval) / interval;
  for (let i = 0; i < n + ahead; i++) {
    const t = i < n ? 0 : (i - n + 1) * interval, k = Math.min(i, n - 1);
    table[2 * i] = z[k] + d[k] * t + 0.5 * a * t * t;
    table[2 * i + 1] = d[k] + a * t;
  }
  return table;
}

// Fourier transform in place, of a length that is a power of two.
const factors = new Map();
function twiddles(n) {
  if (!factors.has(n)) {
    const cos = new Float64Array(n / 2), sin = new Float64Array(n / 2), reversed = new Uint32Array(n);
    for (let k = 0; k < n / 2; k++) {
      cos[k] = Math.cos(2 * Math.PI * k / n);
      sin[k] = -Math.sin(2 * Math.PI * k / n);
    }
    for (let i = 1; i < n; i++) reversed[i] = (reversed[i >> 1] >> 1) | (i & 1 ? n >> 1 : 0);
    factors.set(n, [cos, sin, reversed]);
  }
  return factors.get(n);
}
function transform(re, im) {
  const n = re.length, [cos, sin, reversed] = twiddles(n);
  for (let i = 0; i < n; i++) {
    const j = reversed[i];
    if (j > i) {
      let swap = re[i]; re[i] = re[j]; re[j] = swap;
      swap = im[i]; im[i] = im[j]; im[j] = swap;
    }
  }
  for (let half = 1; half < n; half *= 2) {
    const stride = n / (2 * half);
    for (let first = 0; first < n; first += 2 * half)
      for (let k = 0; k < half; k++) {
        const a = first + k, b = a + half, c = cos[k * stride], s = sin[k * stride];
        const x = re[b] * c - im[b] * s, y = re[b] * s + im[b] * c;
        re[b] = re[a] - x; im[b] = im[a] - y;
        re[a] += x; im[a] += y;
      }
  }
}

// Complex factor of a weighting of ISO 2631-1 at a frequency [Hz], see vehicle/signals/analysis/weighting.py.
function weightingFactor(w, f) {
  const times = (a, b) => [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
  const over = (a, b) => {
    const square = b[0] * b[0] + b[1] * b[1];
    return [(a[0] * b[0] + a[1] * b[1]) / square, (a[1] * b[0] - a[0] * b[1]) / square];
  };
  const quadratic = (x, q) => [1 - x * x, x / q];
  const low = f / w.f1, high = f / w.f2, x4 = f / w.f4;
  let h = over([-low * low, 0], quadratic(low, Math.SQRT1_2));
  h = over(h, quadratic(high, Math.SQRT1_2));
  h = over(times(h, [1, w.f3 === null ? 0 : f / w.f3]), quadratic(x4, w.q4));
  if (w.f5 !== null) {
    h = over(times(h, quadratic(f / w.f5, w.q5)), quadratic(f / w.f6, w.q6));
    h = h.map((part) => part * (w.f5 / w.f6) ** 2);
  }
  return h.map((part) => part * w.gain);
}

const tables = new Map();
function weightingTable(w, length, interval) {
  const key = `${w.name} ${length}`;
  if (!tables.has(key)) {
    const re = new Float64Array(length / 2 + 1), im = new Float64Array(length / 2 + 1);
    for (let k = 0; k <= length / 2; k++) [re[k], im[k]] = weightingFactor(w, k / (length * interval));
    im[length / 2] = 0;
    tables.set(key, [re, im]);
  }
  return tables.get(key);
}

// Two records filtered by one weighting, as real and imaginary part of one record; at rest before the first sample.
function weighted(first, second, w, interval) {
  const n = first.length;
  let length = 2;
  while (length < n + 4 / (w.f1 * interval)) length *= 2;
  const re = new Float64Array(length), im = new Float64Array(length), [hr, hi] = weightingTable(w, length, interval);
  re.set(first);
  if (second) im.set(second);
  transform(re, im);
  for (let k = 0; k < length; k++) {
    const j = k <= length / 2 ? k : length - k, a = hr[j], b = k <= length / 2 ? hi[j] : -hi[j];
    const x = re[k] * a - im[k] * b, y = re[k] * b + im[k] * a;
    // The conjugate, so that the second transform is the inverse.
    re[k] = x; im[k] = -y;
  }
  transform(re, im);
  for (let k = 0; k < n; k++) { re[k] /= length; im[k] /= -length; }
  return [re.subarray(0, n), im.subarray(0, n)];
}

function rms(values, first) {
  let sum = 0;
  for (let k = first; k < values.length; k++) sum += values[k] * values[k];
  return Math.sqrt(sum / (values.length - first));
}

// One-sided density by Welch: Hann windows with half overlap, mean of each removed.
function density(values, first, length, interval) {
  const half = length / 2, sums = new Float64Array(half + 1);
  const hann = Float64Array.from({ length }, (_, i) => 0.5 - 0.5 * Math.cos(2 * Math.PI * i / length));
  let count = 0;
  for (let at = first; at + length <= values.length; at += half, count++) {
    const re = values.slice(at, at + length), im = new Float64Array(length);
    const mean = re.reduce((sum, value) => sum + value, 0) / length;
    for (let i = 0; i < length; i++) re[i] = (re[i] - mean) * hann[i];
    transform(re, im);
    for (let k = 0; k <= half; k++) sums[k] += re[k] * re[k] + im[k] * im[k];
  }
  const power = hann.reduce((sum, value) => sum + value * value, 0);
  return sums.map((sum, k) => sum * (k === 0 || k === half ? 1 : 2) * interval / (power * count));
}

// Samples of a window and of a period; realisations, and periods before the evaluated one: a lightly damped mode of 3 Hz
// takes 12 s to settle. Range of the FRF [Hz].
const LINES = 4096, REALISATIONS = 4, SETTLING = 3, LOWEST = 1, HIGHEST = 50;

class Trial {
  static async open(data) {
    const { instance } = await WebAssembly.instantiate(await bytesOf(data.module), {});
    const plates = await Promise.all(data.plates.map(async ({ changes }) => integersOf(await bytesOf(changes))));
    return new Trial(data, instance.exports, await bytesOf(data.car), plates);
  }

  constructor(data, module, content, integers) {
    this.data = data;
    this.module = module;
    module._initialize();
    const at = module.reserve(content.length);
    new Uint8Array(module.memory.buffer, at, content.length).set(content);
    this.car = module.open_car(at, content.length);
    if (!this.car) throw new Error("the numbers of the car are damaged");
    const { interval, ahead, plateCount, samples } = data;
    this.plates = new Float64Array(2 * plateCount * (samples + ahead));
    data.plates.forEach(({ plate, step }, k) => {
      const table = plateTable(Float64Array.from(integers[k], (value) => step * value), interval, ahead);
      for (let i = 0; i < samples + ahead; i++) this.plates.set(table.subarray(2 * i, 2 * i + 2), 2 * (i * plateCount + plate));
    });
    const most = Math.max(samples, (SETTLING + 1) * LINES) + ahead, outputs = 3 + 2 * data.dampers.length;
    this.places = {
      parameters: module.reserve(8 * data.parameters.flat().length),
      plates: module.reserve(8 * 2 * plateCount * most),
      outputs: module.reserve(4 * outputs),
      values: module.reserve(8 * outputs * most),
    };
  }

  // Histories of outputs, one array each: the car from rest over plates, (z, z') of all plates sample by sample.
  run(parameters, plates, outputs) {
    const { module, places, data } = this, samples = plates.length / (2 * data.plateCount), buffer = module.memory.buffer;
    new Float64Array(buffer, places.parameters, parameters.length).set(parameters);
    new Float64Array(buffer, places.plates, plates.length).set(plates);
    new Int32Array(buffer, places.outputs, outputs.length).set(outputs);
    const done = module.run_car(this.car, places.parameters, places.plates, samples, data.interval, places.outputs, outputs.length, places.values);
    if (done < samples) throw new Error(this.text(module.last_message()));
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
  record(settings) {
    const { data } = this, { interval, skip } = data, count = data.dampers.length, started = performance.now();
    const outputs = [...data.positions, ...data.dampers.flatMap(({ velocity, force }) => [velocity, force])];
    const histories = this.run(this.parametersOf(settings), this.plates.map((value) => settings.level * value), outputs);
    const marched = performance.now(), notices = this.notices(), acceleration = histories.slice(0, 3).map((position) => this.acceleration(position));
    const samples = acceleration[0].length, [w] = data.weightings;
    const [x, y] = weighted(acceleration[0], acceleration[1], w, interval);
    const [z] = weighted(acceleration[2], null, data.weightings[2], interval);
    const axes = [x, y, z].map((history) => rms(history, skip));
    const dampers = Array.from({ length: count }, (_, i) => {
      const velocity = histories[3 + 2 * i].subarray(0, samples), force = histories[4 + 2 * i].subarray(0, samples);
      let slipping = 0, highest = 0;
      for (let k = skip; k < samples; k++) {
        slipping += Math.abs(velocity[k]) > data.dampers[i].slip;
        highest = Math.max(highest, Math.abs(force[k]));
      }
      return { velocity, force, slip: slipping / (samples - skip), highest };
    });
    return {
      acceleration, dampers, axes, notices,
      comfort: Math.hypot(...axes.map((value, axis) => value * data.factors[axis])),
      density: density(acceleration[2], skip, LINES, interval),
      resolution: 1 / (LINES * interval),
      milliseconds: { stepping: marched - started, all: performance.now() - started },
    };
  }

  // FRF of the seat rail, vertical, to the excited plate: multisines of random phase with the density of the record, each
  // after SETTLING periods. Mean over realisations, and its standard error.
  response(settings) {
    const { data } = this, { interval, plateCount, excited } = data, parameters = this.parametersOf(settings);
    const samples = data.samples, z = Float64Array.from({ length: samples }, (_, i) => this.plates[2 * (i * plateCount + excited)]);
    const levels = density(z, data.skip, LINES, interval), last = Math.round(HIGHEST * LINES * interval);
    const frequency = Array.from({ length: last }, (_, k) => (k + 1) / (LINES * interval));
    const re = new Float64Array(last), im = new Float64Array(last), square = new Float64Array(last);
    let seed = 12345;
    const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;
    for (let realisation = 0; realisation < REALISATIONS; realisation++) {
      const sr = new Float64Array(LINES), si = new Float64Array(LINES), vr = new Float64Array(LINES), vi = new Float64Array(LINES);
      for (let k = 1; k <= last; k++) {
        const size = settings.level * Math.sqrt(levels[k] / (2 * LINES * interval)), phase = 2 * Math.PI * random(), omega = 2 * Math.PI * frequency[k - 1];
        // z = sum 2 size cos(omega t + phase): mean square 2 size^2, which is density times resolution.
        sr[k] = sr[LINES - k] = size * Math.cos(phase);
        si[k] = -size * Math.sin(phase); si[LINES - k] = -si[k];
        vr[k] = vr[LINES - k] = -omega * size * Math.sin(phase);
        vi[k] = -omega * size * Math.cos(phase); vi[LINES - k] = -vi[k];
      }
      transform(sr, si);
      transform(vr, vi);
      const plates = new Float64Array(2 * plateCount * ((SETTLING + 1) * LINES + data.ahead));
      for (let i = 0; i < (SETTLING + 1) * LINES + data.ahead; i++) {
        plates[2 * (i * plateCount + excited)] = sr[i % LINES];
        plates[2 * (i * plateCount + excited) + 1] = vr[i % LINES];
      }
      const [position] = this.run(parameters, plates, [data.positions[2]]);
      const response = this.acceleration(position).slice(SETTLING * LINES), quadrature = new Float64Array(LINES);
      const input = sr.slice(), rest = new Float64Array(LINES);
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
      postMessage({ id, task, settings, result: task && (await trial)[task](settings) });
    } catch (error) {
      postMessage({ id, task, settings, error: error.message });
    }
  };
}
