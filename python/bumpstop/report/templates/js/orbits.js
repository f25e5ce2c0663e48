// Paths of nodes in the planes of their round obstacles, beside the moving picture.

const TAIL = 0.06;

class Orbit {
  constructor(law, index, place) {
    this.index = index;
    this.orbit = law.orbit;
    const figure = document.createElement("figure");
    figure.className = "orbit";
    const caption = document.createElement("figcaption");
    caption.textContent = `Within ${law.name}`;
    this.told = document.createElement("span");
    caption.append(this.told);
    const [right, up] = this.orbit.axes;
    const label = `Path of the node within ${law.name}: ${right} to the right, ${up} up`;
    this.element = svg("svg", { class: "stage", role: "img", "aria-label": label });
    figure.append(this.element, caption);
    place.append(figure);
  }

  // The whole path and the obstacle, in a square of some pixels.
  layOut(motion, size) {
    const { outline, places } = this.orbit;
    const [border, path] = [rowsOf(outline, 2), rowsOf(places, 2)];
    const seen = [...border, ...path];
    const low = [0, 1].map((axis) => seen.reduce((least, row) => Math.min(least, row[axis]), Infinity));
    const high = [0, 1].map((axis) => seen.reduce((most, row) => Math.max(most, row[axis]), -Infinity));
    const scale = (size - 44) / (Math.max(high[0] - low[0], high[1] - low[1]) || 1);
    const middle = [0, 1].map((axis) => (low[axis] + high[axis]) / 2);
    this.at = ([x, y]) => [
      size / 2 + (x - middle[0]) * scale,
      size / 2 - (y - middle[1]) * scale,
    ];
    const { element } = this;
    element.replaceChildren();
    setSize(element, size, size);
    element.dataset.scale = String(scale);
    svg("path", { class: "border", d: pathThrough(border.map(this.at)) }, element);
    this.path = path;
    const [free, touching] = this.split(motion);
    svg("path", { class: "orbit-path", d: free }, element);
    svg("path", { class: "orbit-path touching", d: touching }, element);
    this.tail = svg("path", { class: "orbit-tail" }, element);
    this.dot = svg("circle", { class: "cursor-dot", r: 6 }, element);
    this.arrow = svg("path", { class: "force" }, element);
    const [right, up] = this.orbit.axes.map((name) => name.replace("Along ", ""));
    const across = svg("text", { class: "label", x: size - 8, y: size - 8, "text-anchor": "end" }, element);
    across.textContent = `${right} →`;
    svg("text", { class: "label", x: 8, y: 18 }, element).textContent = `↑ ${up}`;
  }

  // The path where nothing pushes, and where the obstacle does.
  split(motion) {
    const parts = ["", ""];
    const places = this.path.map(this.at);
    for (let frame = 0; frame < motion.last; frame += 1) {
      const forces = [frame, frame + 1].map((each) => motion.forceAt(this.index, each));
      const pressed = Math.max(...forces) > 0;
      parts[pressed ? 1 : 0] += pathThrough([places[frame], places[frame + 1]]);
    }
    return parts;
  }

  show(motion) {
    if (!this.at) return;
    const { frame, last } = motion;
    const pair = (values) => [0, 1].map((axis) => motion.between(values, axis, 2, frame));
    const here = this.at(pair(this.orbit.places));
    const first = Math.max(0, Math.floor(frame - TAIL * last));
    const passed = this.path.slice(first, Math.floor(frame) + 1).map(this.at);
    set(this.tail, { d: pathThrough([...passed, here]) });
    set(this.dot, { cx: here[0], cy: here[1] });
    const [right, up] = pair(this.orbit.pushes);
    forceArrow(this.arrow, here, [right, -up], Math.hypot(right, up) / motion.largestForce, 8);
    const [newton, unit] = motion.scene.forceScale;
    const push = steady(motion.forceAt(this.index, frame) * newton, motion.largestForce * newton);
    this.told.textContent = ` ${push} ${unit}`;
  }
}
