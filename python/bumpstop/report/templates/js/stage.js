// A structure on paper: where its points are, how modes move them, and what holds it.

const BODY_RADIUS = 13;
const BEAM_HALF_WIDTH = 3.5;
const SHORTEST_SPRING = 42;

class Stage {
  // `scene` has points (2 a point), shapes (2 rows a point, one column a mode), lines, supports.
  constructor(element, scene) {
    this.element = element;
    this.scene = scene;
    this.pointCount = scene.points.length / 2;
    this.modeCount = scene.shapes.length / scene.points.length;
    this.magnification = 1;
    this.largestScale = Infinity;
    this.ranges = null;
  }

  // Displacement of a point, in m on the paper, for given modal displacements.
  displacement(point, modal) {
    const { shapes } = this.scene;
    const moved = [0, 0];
    for (let axis = 0; axis < 2; axis += 1) {
      const row = (2 * point + axis) * this.modeCount;
      for (let mode = 0; mode < this.modeCount; mode += 1) {
        moved[axis] += shapes[row + mode] * modal[mode];
      }
    }
    return moved;
  }

  // Say which motions must fit: an array of modal displacements.
  reach(motions) {
    const ranges = Array.from({ length: this.pointCount }, () => [0, 0, 0, 0]);
    for (const modal of motions) {
      for (let point = 0; point < this.pointCount; point += 1) {
        const [x, y] = this.displacement(point, modal);
        const range = ranges[point];
        range[0] = Math.min(range[0], x);
        range[1] = Math.max(range[1], x);
        range[2] = Math.min(range[2], y);
        range[3] = Math.max(range[3], y);
      }
    }
    this.ranges = ranges;
  }

  // Choose scale and height for a width in pixels.
  fit(width, tallest) {
    const box = this.box();
    const pad = this.padding();
    const room = [Math.max(width - pad.left - pad.right, 40), tallest - pad.top - pad.bottom];
    const spread = [box[1] - box[0], box[3] - box[2]];
    const scales = [0, 1].map((axis) => (spread[axis] > 0 ? room[axis] / spread[axis] : Infinity));
    this.scale = Math.min(...scales);
    if (!Number.isFinite(this.scale)) this.scale = 1;
    // What is turned may become smaller on paper to fit, but does not jump back.
    this.scale = Math.min(this.scale, this.largestScale);
    this.width = width;
    this.height = Math.min(tallest, Math.max(spread[1] * this.scale + pad.top + pad.bottom, 170));
    this.origin = [
      pad.left + (width - pad.left - pad.right) / 2 - ((box[0] + box[1]) / 2) * this.scale,
      pad.top + (this.height - pad.top - pad.bottom) / 2 + ((box[2] + box[3]) / 2) * this.scale,
    ];
    setSize(this.element, this.width, this.height);
    this.element.dataset.scale = String(this.scale * this.magnification);
  }

  box() {
    const { points } = this.scene;
    const box = [Infinity, -Infinity, Infinity, -Infinity];
    const include = (x, y) => {
      box[0] = Math.min(box[0], x);
      box[1] = Math.max(box[1], x);
      box[2] = Math.min(box[2], y);
      box[3] = Math.max(box[3], y);
    };
    for (let i = 0; i < this.pointCount; i += 1) {
      const range = this.ranges ? this.ranges[i] : [0, 0, 0, 0];
      const [x, y] = [points[2 * i], points[2 * i + 1]];
      include(x + this.magnification * range[0], y + this.magnification * range[2]);
      include(x + this.magnification * range[1], y + this.magnification * range[3]);
    }
    for (const law of this.scene.laws ?? []) {
      const [x, y] = [points[2 * law.point], points[2 * law.point + 1]];
      for (const [right, up] of this.farthest(law)) {
        include(x + this.magnification * right, y + this.magnification * up);
      }
    }
    return box;
  }

  // Places of an obstacle that must be seen, from its node at rest.
  farthest(law) {
    if (law.kind === "plane") return [law.normal.map((part) => law.lowest * part)];
    return law.kind === "round" ? rowsOf(law.outline, this.dimensions).map((row) => this.flat(row)) : [];
  }

  // How many components vectors of the scene have, and what is seen of one on paper.
  get dimensions() {
    return this.scene.flat ? 3 : 2;
  }

  flat(vector) {
    return this.scene.flat ? this.scene.flat(vector) : vector;
  }

  padding() {
    const pad = { left: 40, right: 40, top: 28, bottom: 34 };
    const below = SHORTEST_SPRING + BODY_RADIUS + 16;
    const held = [...(this.scene.laws ?? []), ...(this.scene.springs ?? [])];
    // What stands on the ground needs room for it.
    for (const { normal, kind, other } of held) {
      if (kind === "round" || other >= 0) continue;
      // Room for the label under a spring that lies.
      if (Math.abs(normal[0]) > 0.5) pad.bottom = Math.max(pad.bottom, 52);
      if (normal[0] > 0.3) pad.left = Math.max(pad.left, below);
      if (normal[0] < -0.3) pad.right = Math.max(pad.right, below);
      if (normal[1] < -0.3) pad.top = Math.max(pad.top, below);
      if (normal[1] > 0.3) pad.bottom = Math.max(pad.bottom, below);
    }
    return pad;
  }

  // Paper coordinates in m to pixels.
  toPixels(x, y) {
    return [this.origin[0] + x * this.scale, this.origin[1] - y * this.scale];
  }

  rest(point) {
    const { points } = this.scene;
    return this.toPixels(points[2 * point], points[2 * point + 1]);
  }

  place(point, modal) {
    const { points } = this.scene;
    const [u, v] = this.displacement(point, modal);
    return this.toPixels(
      points[2 * point] + this.magnification * u,
      points[2 * point + 1] + this.magnification * v,
    );
  }

  // How far a point goes against a direction at most, in pixels.
  retreat(point, direction) {
    const [x, y] = direction;
    const length = Math.hypot(x, y) || 1;
    const [left, right, down, up] = this.ranges ? this.ranges[point] : [0, 0, 0, 0];
    const least = Math.min(x * left, x * right) + Math.min(y * down, y * up);
    return (-least / length) * this.scale * this.magnification;
  }

  linePath([first, count], modal) {
    const points = [];
    for (let i = first; i < first + count; i += 1) {
      points.push(modal ? this.place(i, modal) : this.rest(i));
    }
    return pathThrough(points);
  }

  // Whether the beams that meet at a node all stand rather than lie.
  onlyPostsMeetAt(point) {
    const here = this.rest(point);
    const ends = this.scene.lines.flatMap(([first, count]) => {
      const pair = [this.rest(first), this.rest(first + count - 1)];
      return [pair, [...pair].reverse()];
    });
    const meeting = ends.filter(([end]) => Math.hypot(end[0] - here[0], end[1] - here[1]) < 0.5);
    const stands = ([end, other]) => Math.abs(other[1] - end[1]) > Math.abs(other[0] - end[0]);
    return meeting.length > 0 && meeting.every(stands);
  }

  // The parts that do not move: the undeformed axis and the supports.
  drawFixedParts(group) {
    for (const line of this.scene.lines) {
      svg("path", { class: "axis-line", d: this.linePath(line, null) }, group);
    }
    this.rollers = [];
    for (const support of this.scene.supports) this.drawSupport(group, support);
  }

  // Rollers go with their nodes.
  moveRollers(modal) {
    for (const { group, point, turn } of this.rollers) {
      const [x, y] = this.place(point, modal);
      set(group, { transform: `translate(${x.toFixed(2)} ${y.toFixed(2)}) rotate(${turn})` });
    }
  }

  drawSupport(group, { point, kind, normal }) {
    const [x, y] = this.rest(point);
    // A body on a guide needs no roller to be understood.
    if (kind === "roller" && this.scene.bodies.includes(point)) return;
    // Symbols are drawn as if they held from below.
    const turn = ((Math.atan2(normal[0], normal[1]) * 180) / Math.PI).toFixed(1);
    const place = svg("g", { transform: `translate(${x} ${y}) rotate(${turn})` }, group);
    if (kind === "clamp") {
      svg("path", { class: "ground", d: groundPath([0, 0], [0, -1], 24) }, place);
      return;
    }
    const roller = kind === "roller";
    const foot = roller ? 16 : 18;
    svg("path", { class: "support", d: `M0 0l-10 ${foot}h20z` }, place);
    if (roller) {
      for (const shift of [-5, 5]) {
        svg("circle", { class: "support", cx: shift, cy: foot + 3, r: 3 }, place);
      }
      this.rollers.push({ group: place, point, turn });
    }
    svg("path", { class: "ground", d: groundPath([0, foot + (roller ? 6 : 0)], [0, -1], 17) }, place);
  }
}
