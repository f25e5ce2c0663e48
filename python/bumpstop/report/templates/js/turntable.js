// A scene in space, seen from where the reader turns it to.

const LOWEST = -Math.PI / 2;
const HIGHEST = Math.PI / 2;
const RADIANS_A_PIXEL = 0.01;
const RADIANS_A_KEY = Math.PI / 24;

class Turntable {
  // `scene` has points, shapes and normals to the right, up and towards the reader.
  constructor(scene) {
    this.scene = scene;
    this.azimuth = 0;
    this.tilt = 0;
    this.elevation = Math.atan2(scene.vertical[2], scene.vertical[1]);
  }

  turn(azimuth, tilt) {
    this.azimuth += azimuth;
    const elevation = this.elevation + this.tilt + tilt;
    this.tilt = Math.min(Math.max(elevation, LOWEST), HIGHEST) - this.elevation;
  }

  // The scene on paper, for a stage.
  onPaper() {
    const { scene } = this;
    const [right, up] = this.paper();
    const modes = scene.shapes.length / scene.points.length;
    const points = new Float32Array((scene.points.length / 3) * 2);
    const shapes = new Float32Array(points.length * modes);
    [right, up].forEach((axis, row) => {
      for (let point = 0; point < points.length / 2; point += 1) {
        for (let part = 0; part < 3; part += 1) {
          points[2 * point + row] += axis[part] * scene.points[3 * point + part];
          for (let mode = 0; mode < modes; mode += 1) {
            shapes[(2 * point + row) * modes + mode] +=
              axis[part] * scene.shapes[(3 * point + part) * modes + mode];
          }
        }
      }
    });
    const flat = (vector) => [dot(right, vector), dot(up, vector)];
    const across = (part) => {
      const seen = { ...part, normal: flat(part.normal) };
      if (part.slider) seen.slider = { ...part.slider, direction: flat(part.slider.direction) };
      return seen;
    };
    return {
      ...scene,
      points,
      shapes,
      flat,
      supports: scene.supports.map(across),
      laws: (scene.laws ?? []).map(across),
      springs: (scene.springs ?? []).map(across),
    };
  }

  // Right and up of the paper, in the components of the scene.
  paper() {
    const axes = [[1, 0, 0], [0, Math.cos(this.tilt), -Math.sin(this.tilt)]];
    return axes.map((axis) => turned(axis, this.scene.vertical, -this.azimuth));
  }
}

// Let a drawing be turned by dragging it, and by the arrow keys: `turn` takes azimuth and tilt.
function letTurn(element, turn) {
  element.addEventListener("pointerdown", (event) => element.setPointerCapture(event.pointerId));
  element.addEventListener("pointermove", (event) => {
    if (!element.hasPointerCapture(event.pointerId)) return;
    turn(event.movementX * RADIANS_A_PIXEL, event.movementY * RADIANS_A_PIXEL);
  });
  const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  element.addEventListener("keydown", (event) => {
    if (!(event.key in turns)) return;
    event.preventDefault();
    turn(...turns[event.key].map((step) => step * RADIANS_A_KEY));
  });
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// A vector turned about a unit axis (Rodrigues' formula).
function turned(vector, axis, angle) {
  const [x, y, z] = vector;
  const [a, b, c] = axis;
  const across = [b * z - c * y, c * x - a * z, a * y - b * x];
  const along = (1 - Math.cos(angle)) * dot(axis, vector);
  return vector.map(
    (part, i) => Math.cos(angle) * part + Math.sin(angle) * across[i] + along * axis[i],
  );
}
