"use strict";
// Packed numbers, heights between samples, Fourier transform, weightings of ISO 2631-1 and densities for the worker of
// the trial.

// Bytes from base 85, which packed_numbers.py writes, and deflate.
const DIGITS = new Map([..."0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%&()*+-;,=>?@^_`{|}~"].map((letter, k) => [letter.charCodeAt(0), k]));
async function bytesOf(text) {
  const packed = new DataView(new ArrayBuffer(4 * Math.ceil(text.length / 5)));
  for (let at = 0; at < text.length; at += 5) {
    let value = 0;
    for (let k = at; k < at + 5; k++) value = 85 * value + (k < text.length ? DIGITS.get(text.charCodeAt(k)) : 84);
    packed.setUint32(at / 5 * 4, value);
  }
  const stream = new Blob([packed.buffer.slice(0, Math.floor(text.length * 4 / 5))]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Words of 8 bytes from runs [count, bytes, times] of their most significant bytes, bytes of equal significance together;
// each word is there `times` times.
function wordsOf(bytes, runs) {
  const words = new Uint8Array(8 * runs.reduce((sum, [count, , times]) => sum + count * times, 0));
  let from = 0, to = 0;
  for (const [count, size, times] of runs) {
    for (let byte = 8 - size; byte < 8; byte++)
      for (let k = 0; k < count; k++, from++) for (let t = 0; t < times; t++) words[to + 8 * (k * times + t) + byte] = bytes[from];
    to += 8 * count * times;
  }
  return words;
}

// Integers from their differences of an order modulo 2^16, low bytes first.
function integersOf(bytes, order) {
  const n = bytes.length / 2, values = Int16Array.from({ length: n }, (_, i) => bytes[i] | bytes[n + i] << 8);
  for (let k = 0; k < order; k++) for (let i = 1; i < n; i++) values[i] += values[i - 1];
  return values;
}

// Heights of a track at places ratio k - behind [samples], 0 before its begin; see page_input.py.
function heightsAt(z, ratio, behind, count) {
  if (ratio === 1 && behind === 0) return z;
  const d = splineDerivatives(z, 1), result = new Float64Array(count);
  for (let k = 0; k < count; k++) {
    const at = ratio * k - behind, i = Math.min(Math.floor(at), z.length - 2), t = at - i, r = 1 - t;
    if (at > 0) result[k] = r * r * (1 + 2 * t) * z[i] + t * t * (1 + 2 * r) * z[i + 1] + t * r * (r * d[i] - t * d[i + 1]);
  }
  return result;
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
