// Laws as they are drawn: a plate before its spring, a hole, or what joins two nodes.

const SEEN_FROM_ITS_FRONT = 0.2;
const LANE = 17;

// What pushes or pulls in a law: `full` is its length where nothing presses it.
function linkPath(symbol, from, to, full) {
  if (Math.hypot(to[0] - from[0], to[1] - from[1]) < 10) return pathThrough([from, to]);
  if (symbol === "damper") return dashpotPath(from, to);
  if (symbol === "device") return boxPath(from, to);
  if (symbol === "strut") return strutPath(from, to, full);
  return springPath(from, to);
}

// An arrow from a point along a direction in pixels, as long as its share of the largest force.
function forceArrow(path, from, direction, share, start) {
  // Nothing but rounding, or a law that never pushes for a while.
  if (!(share > 1e-9) || Math.hypot(...direction) < 1e-9) {
    path.setAttribute("d", "");
    return;
  }
  const tip = start + 14 + 38 * share;
  const { at } = between(from, [from[0] + direction[0], from[1] + direction[1]]);
  const head = pathThrough([at(tip - 8, -5), at(tip, 0), at(tip - 8, 5)]);
  path.setAttribute("d", pathThrough([at(start, 0), at(tip, 0)]) + head);
}

// Drawings of springs and laws, in this order.
function makeDrawings(scene, stage) {
  const lanes = new Map();
  return [...scene.springs, ...scene.laws].map((law) => {
    if (law.kind === "round") return new RoundDrawing(law, stage);
    if (law.kind === "plane") return makePlane(law, stage);
    const ends = [law.point, law.other].sort().join(" ");
    const lane = lanes.get(ends) ?? 0;
    lanes.set(ends, lane > 0 ? -lane : 1 - lane);
    return new LinkDrawing(law, stage, lane);
  });
}

function makePlane(law, stage) {
  const seen = Math.hypot(...law.normal) >= SEEN_FROM_ITS_FRONT;
  return seen ? new PlaneDrawing(law, stage) : new FrontDrawing(law, stage);
}

class LawDrawing {
  constructor(law, stage) {
    this.law = law;
    this.stage = stage;
    this.group = svg("g", { class: "stop" }, stage.element);
    this.group.dataset.stop = law.name;
    this.reach = stage.scene.bodies.includes(law.point) ? BODY_RADIUS : BEAM_HALF_WIDTH;
  }

  // The arrows of forces lie over everything else, so they are made last.
  addArrow() {
    if (this.law.forces) this.arrow = svg("path", { class: "force" }, this.stage.element);
  }

  label(attributes) {
    const label = svg("text", { class: "label", ...attributes }, this.group);
    label.textContent = this.law.label;
    keepInside(label, this.stage.width);
    return label;
  }

  // Where its ground is, or the node that carries it.
  foot(modal, distance, rest) {
    const { law, stage } = this;
    if (law.other >= 0) return stage.place(law.other, modal);
    const [x, y] = law.normal;
    const length = Math.hypot(x, y) || 1;
    return [rest[0] - (x / length) * distance, rest[1] + (y / length) * distance];
  }
}

// A plate that faces the node, before a spring on the ground or on another node.
class PlaneDrawing extends LawDrawing {
  constructor(law, stage) {
    super(law, stage);
    const [x, y] = law.normal;
    const length = Math.hypot(x, y);
    this.normal = [x / length, -y / length];
    this.pixels = stage.scale * stage.magnification * length;
    this.rest = stage.rest(law.point);
    const ground = this.reach - law.lowest * this.pixels + SHORTEST_SPRING;
    this.behind = ground - this.reach + law.surface * this.pixels;
    this.ground = svg("path", { class: "ground" }, this.group);
    if (law.other < 0 && !law.surfaces) this.showGround(this.groundAt(law.surface));
    if (law.symbol !== "rigid") this.spring = svg("path", { class: "spring" }, this.group);
    this.plate = svg("path", { class: "plate" }, this.group);
    if (law.slider) this.slider = svg("path", { class: "slider" }, this.group);
    const surface = this.away(this.reach - law.surface * this.pixels);
    this.placeLabel(this.away(this.groundAt(law.surface)), surface);
  }

  away(distance) {
    return [this.rest[0] - this.normal[0] * distance, this.rest[1] - this.normal[1] * distance];
  }

  // How far behind the node at rest the ground is.
  groundAt(surface) {
    const rigid = this.law.symbol === "rigid";
    return this.reach - surface * this.pixels + (rigid ? 2 : this.behind);
  }

  showGround(distance) {
    set(this.ground, { d: groundPath(this.away(distance), this.normal) });
  }

  // Beside the ground of a spring that stands, under one that lies.
  placeLabel(foot, surface) {
    if (Math.abs(this.normal[1]) <= 0.5) {
      this.label({ x: (foot[0] + surface[0]) / 2, y: foot[1] + 38, "text-anchor": "middle" });
      return;
    }
    const left = foot[0] > this.stage.width / 2;
    this.label({ x: foot[0] + (left ? -26 : 26), y: foot[1], "text-anchor": left ? "end" : "start" });
  }

  show(motion, index, modal) {
    const { law, pixels } = this;
    const at = (values) => motion.between(values, 0, 1, motion.frame);
    const surface = law.surfaces ? at(law.surfaces) : law.surface;
    const closed = motion.isClosed(index, motion.timeAt(motion.frame));
    const pressed = closed && law.symbol !== "rigid" ? Math.max(0, -at(law.gaps)) : 0;
    const plate = this.away(this.reach - (surface - pressed) * pixels);
    if (law.surfaces && law.other < 0) this.showGround(this.groundAt(surface));
    const foot = this.foot(modal, this.groundAt(surface), this.rest);
    if (this.spring) set(this.spring, { d: linkPath(law.symbol, plate, foot, this.behind) });
    const across = [-this.normal[1] * 14, this.normal[0] * 14];
    const ends = [-1, 1].map((side) => [plate[0] + side * across[0], plate[1] + side * across[1]]);
    set(this.plate, { d: law.symbol === "sphere" ? this.bulge(plate, ends) : pathThrough(ends) });
    this.group.dataset.contact = closed ? "closed" : "open";
    if (this.slider) set(this.slider, { d: this.sliderPath(plate, motion, modal) });
    const share = motion.forceAt(index, motion.frame) / motion.largestForce;
    forceArrow(this.arrow, plate, this.normal, share, 2 * this.reach + 3);
  }

  // A diamond on the obstacle where the slider of friction stands; nothing where there is none.
  sliderPath(plate, motion, modal) {
    const { law, stage } = this;
    const place = law.slider.places[Math.round(motion.frame)];
    if (!Number.isFinite(place)) return "";
    const pixels = stage.scale * stage.magnification;
    const carried = law.other >= 0 ? stage.displacement(law.other, modal) : [0, 0];
    const [right, up] = carried.map((part, axis) => part + place * law.slider.direction[axis]);
    const [x, y] = [plate[0] + right * pixels, plate[1] - up * pixels];
    return `M${x - 5} ${y}L${x} ${y - 5}L${x + 5} ${y}L${x} ${y + 5}Z`;
  }

  // A round face whose top is where a plate would be.
  bulge(top, ends) {
    const behind = ends.map(([x, y]) => `${x - this.normal[0] * 7} ${y - this.normal[1] * 7}`);
    const ahead = top.map((part, axis) => part + this.normal[axis] * 7);
    return `M${behind[0]}Q${ahead.join(" ")} ${behind[1]}`;
  }
}

// A plane seen from its front has no side to draw: a ring about its node.
class FrontDrawing extends LawDrawing {
  constructor(law, stage) {
    super(law, stage);
    this.ring = svg("circle", { class: "plate", r: 12, fill: "none" }, this.group);
  }

  show(motion, index, modal) {
    const [cx, cy] = this.stage.place(this.law.point, modal);
    set(this.ring, { cx, cy });
    const closed = motion.isClosed(index, motion.timeAt(motion.frame));
    this.group.dataset.contact = closed ? "closed" : "open";
    forceArrow(this.arrow, [cx, cy], [0, 0], 0, 0);
  }
}

// What joins a node to another one, or to the ground; `lane` tells those side by side apart.
class LinkDrawing extends LawDrawing {
  constructor(law, stage, lane = 0) {
    super(law, stage);
    this.lane = lane * LANE;
    this.distance = SHORTEST_SPRING + this.reach + stage.retreat(law.point, law.normal);
    const rest = stage.rest(law.point);
    const foot = law.other >= 0 ? stage.rest(law.other) : this.foot(null, this.distance, rest);
    if (law.other < 0) {
      const [x, y] = law.normal;
      const length = Math.hypot(x, y) || 1;
      svg("path", { class: "ground", d: groundPath(foot, [x / length, -y / length]) }, this.group);
    }
    this.foothold = foot;
    this.spring = svg("path", { class: "spring" }, this.group);
    if (law.label) {
      this.label({ x: (rest[0] + foot[0]) / 2, y: (rest[1] + foot[1]) / 2 + 26, "text-anchor": "middle" });
    }
  }

  show(motion, index, modal) {
    const { law, stage } = this;
    const from = stage.place(law.point, modal);
    const to = law.other >= 0 ? stage.place(law.other, modal) : this.foothold;
    const { at, length } = between(from, to);
    const ends = this.lane ? [at(0, this.lane), at(length, this.lane)] : [from, to];
    set(this.spring, { d: linkPath(law.symbol, ...ends, this.distance) });
    if (!this.arrow) return;
    const force = motion.forceAt(index, motion.frame);
    const along = [Math.sign(force) * law.normal[0], -Math.sign(force) * law.normal[1]];
    forceArrow(this.arrow, from, along, Math.abs(force) / motion.largestForce, this.reach + 2);
  }
}

// An obstacle about an axis: its border as the node may reach it.
class RoundDrawing extends LawDrawing {
  constructor(law, stage) {
    super(law, stage);
    this.border = svg("path", { class: "border" }, this.group);
    this.points = rowsOf(law.outline, stage.dimensions).map((row) => stage.flat(row));
    const rest = stage.rest(law.point);
    const pixels = stage.scale * stage.magnification;
    const lowest = Math.min(...this.points.map(([, up]) => up), 0);
    this.under = -lowest * pixels + 22;
    this.text = this.label({ x: rest[0], y: rest[1] + this.under, "text-anchor": "middle" });
  }

  show(motion, index, modal) {
    const { law, stage } = this;
    // It is as long as its axis: what is drawn is where the node is along it.
    const slid = motion.between(law.slides, 0, 1, motion.frame);
    const along = stage.flat(Array.from(law.axis, (part) => part * slid));
    const other = law.other >= 0 ? stage.displacement(law.other, modal) : [0, 0];
    const carried = other.map((part, axis) => part + along[axis]);
    const rest = stage.rest(law.point);
    const pixels = stage.scale * stage.magnification;
    const points = this.points.map(([right, up]) => [
      rest[0] + (right + carried[0]) * pixels,
      rest[1] - (up + carried[1]) * pixels,
    ]);
    set(this.border, { d: pathThrough(points) });
    set(this.text, { x: rest[0] + carried[0] * pixels, y: rest[1] - carried[1] * pixels + this.under });
    keepInside(this.text, stage.width);
    const closed = motion.isClosed(index, motion.timeAt(motion.frame));
    this.group.dataset.contact = closed ? "closed" : "open";
    const size = stage.dimensions;
    const vector = Array.from({ length: size }, (_, part) =>
      motion.between(law.vectors, part, size, motion.frame),
    );
    const [right, up] = stage.flat(vector);
    const share = Math.hypot(right, up) / motion.largestForce;
    forceArrow(this.arrow, stage.place(law.point, modal), [right, -up], share, this.reach + 2);
  }
}
