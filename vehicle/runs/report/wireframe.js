"use strict";
// Points and lines of a car on a picture, for all moving pictures. Frame: x to the rear, y right, z up; lengths in mm.
const wireframe = (() => {
  const TURN = 2 * Math.PI;
  const WIDTH = { body: 2, mass: 1.6, link: 2.6, spring: 1.3, wheel: 1.4, ground: 1 };
  const VIEWS = { corner: [128, 20], side: [90, 4], front: [180, 4], top: [180, 89] };

  // Middle, size and height of a car on the picture.
  function measure(car) {
    const n = car.points.length / 3, points = Array.from({ length: n }, (_, i) => i);
    car.middle = [0, 1, 2].map((axis) => {
      const along = points.map((i) => car.points[3 * i + axis]);
      return (Math.min(...along) + Math.max(...along)) / 2;
    });
    car.size = Math.max(...points.map((i) => Math.hypot(...[0, 1, 2].map((axis) => car.points[3 * i + axis] - car.middle[axis]))));
    // How high the car is on the page, seen from the corner: a tall body must not be cut.
    const [a, e] = VIEWS.corner.map((angle) => angle * TURN / 360);
    const rise = [-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e)];
    car.high = Math.max(...points.map((i) => Math.abs([0, 1, 2].reduce((sum, axis) => sum + rise[axis] * (car.points[3 * i + axis] - car.middle[axis]), 0))));
  }

  // Places of all points: across, down, and towards the eye. View: azimuth and elevation [deg], zoom; moved: displacements.
  function project(car, [azimuth, elevation, zoom], width, height, moved) {
    const a = azimuth * TURN / 360, e = elevation * TURN / 360;
    const right = [-Math.sin(a), Math.cos(a), 0];
    const up = [-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e)];
    const eye = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
    const scale = zoom * Math.min(0.47 * width / car.size, 0.86 * height / car.size, 0.42 * height / car.high), places = [];
    for (let i = 0; i < car.points.length; i += 3) {
      let x = 0, y = 0, z = 0;
      for (let axis = 0; axis < 3; axis++) {
        const at = car.points[i + axis] - car.middle[axis] + (moved ? moved[i + axis] : 0);
        x += right[axis] * at; y += up[axis] * at; z += eye[axis] * at;
      }
      const near = scale / (1 - 0.12 * z / car.size);
      places.push([width / 2 + near * x, height / 2 - near * y, z]);
    }
    return places;
  }

  return { VIEWS, WIDTH, measure, project };
})();
