// The modes: a thumbnail of each shape in the table, and the chosen one drawn large.

const SWING_SECONDS = 2;

class Modes {
  constructor(root, scene) {
    this.root = root;
    this.table = scene.vertical ? new Turntable(scene) : null;
    this.scene = this.table ? this.table.onPaper() : scene;
    this.chosen = 0;
    this.phase = Math.PI / 2;
    this.swinging = false;
    this.stage = this.makeStage(root.querySelector("[data-part=mode-stage]"));
    this.button = root.querySelector("[data-part=swing]");
    this.radios = [...root.querySelectorAll("input[type=radio]")];
    this.title = root.querySelector("[data-part=mode-title]");
    this.radios.forEach((radio, mode) => {
      radio.addEventListener("change", () => this.choose(mode));
      radio.closest("tr").addEventListener("click", () => {
        radio.checked = true;
        this.choose(mode);
      });
    });
    this.button.addEventListener("click", () => this.setSwinging(!this.swinging));
    if (this.table) letTurn(this.stage.element, (...by) => this.turn(...by));
    this.drawThumbnails();
    new ResizeObserver(() => this.layOut()).observe(root);
    this.choose(0);
  }

  makeStage(element) {
    const stage = new Stage(element, this.scene);
    const { points } = this.scene;
    let extent = 0;
    for (let axis = 0; axis < 2; axis += 1) {
      const along = points.filter((_, i) => i % 2 === axis);
      extent = Math.max(extent, Math.max(...along) - Math.min(...along));
    }
    stage.magnification = extent > 0 ? 0.13 * extent : 1;
    stage.reach(this.allModes());
    return stage;
  }

  turn(azimuth, tilt) {
    this.table.turn(azimuth, tilt);
    this.scene = this.table.onPaper();
    this.stage.scene = this.scene;
    this.stage.largestScale = this.stage.scale;
    this.layOut();
  }

  allModes() {
    const motions = [];
    for (let mode = 0; mode < this.scene.shapes.length / this.scene.points.length; mode += 1) {
      motions.push(this.modal(mode, 1), this.modal(mode, -1));
    }
    return motions;
  }

  modal(mode, amplitude) {
    const modal = new Float64Array(this.scene.shapes.length / this.scene.points.length);
    modal[mode] = amplitude;
    return modal;
  }

  drawThumbnails() {
    this.root.querySelectorAll("[data-thumbnail]").forEach((element) => {
      const small = this.makeStage(element);
      const mode = Number(element.dataset.thumbnail);
      small.padding = () => ({ left: 3, right: 3, top: 4, bottom: 4 });
      small.fit(96, 30);
      small.element.setAttribute("height", "30");
      for (const line of this.scene.lines) {
        svg("path", { class: "axis-line", d: small.linePath(line, null) }, element);
        svg("path", { class: "thumbnail-line", d: small.linePath(line, this.modal(mode, 1)) }, element);
      }
      for (const point of this.scene.bodies) {
        svg("path", { class: "axis-line", d: this.swingPath(small, point, mode) }, element);
        const [cx, cy] = small.place(point, this.modal(mode, 1));
        svg("circle", { class: "thumbnail-dot", cx, cy, r: 3 }, element);
      }
    });
  }

  // From one extreme of a body's motion to the other.
  swingPath(stage, point, mode) {
    return pathThrough([-1, 1].map((extreme) => stage.place(point, this.modal(mode, extreme))));
  }

  choose(mode) {
    this.chosen = mode;
    this.title.textContent = this.radios[mode].dataset.title;
    this.root.querySelectorAll("tbody tr").forEach((row, i) => {
      row.classList.toggle("is-chosen", i === mode);
    });
    this.layOut();
  }

  setSwinging(swinging) {
    this.swinging = swinging;
    this.button.dataset.state = swinging ? "playing" : "paused";
    this.button.querySelector("span").textContent = swinging ? "Pause" : "Animate";
    if (!swinging) {
      this.phase = Math.PI / 2;
      this.show();
      return;
    }
    this.before = null;
    requestAnimationFrame((now) => this.tick(now));
  }

  tick(now) {
    if (!this.swinging) return;
    const elapsed = this.before === null ? 0 : (now - this.before) / 1000;
    this.before = now;
    this.phase += (2 * Math.PI * elapsed) / SWING_SECONDS;
    this.show();
    requestAnimationFrame((next) => this.tick(next));
  }

  layOut() {
    const { stage, scene } = this;
    const width = stage.element.parentElement.clientWidth;
    if (width === 0) return;
    if (this.table) stage.reach([this.modal(this.chosen, 1), this.modal(this.chosen, -1)]);
    stage.fit(width, this.tallest());
    stage.element.replaceChildren();
    stage.drawFixedParts(svg("g", {}, stage.element));
    for (const extreme of [1, -1]) {
      for (const line of scene.lines) {
        const d = stage.linePath(line, this.modal(this.chosen, extreme));
        svg("path", { class: "extreme", d }, stage.element);
      }
    }
    for (const point of scene.bodies) {
      const d = this.swingPath(stage, point, this.chosen);
      svg("path", { class: "axis-line", d }, stage.element);
      const [cx, cy] = stage.rest(point);
      svg("circle", { class: "rest", cx, cy, r: BODY_RADIUS }, stage.element);
    }
    this.lines = scene.lines.map(() => svg("path", { class: "beam" }, stage.element));
    this.dots = scene.nodes.map(({ name, point }) => {
      const body = scene.bodies.includes(point);
      const dot = svg("circle", { class: body ? "body" : "node", r: body ? BODY_RADIUS : 4 });
      dot.dataset.node = name;
      stage.element.append(dot);
      return dot;
    });
    this.show();
  }

  tallest() {
    if (this.table) return 420;
    return this.scene.lines.length ? 300 : 220;
  }

  show() {
    if (!this.lines) return;
    const { stage, scene } = this;
    const modal = this.modal(this.chosen, Math.sin(this.phase));
    stage.moveRollers(modal);
    scene.lines.forEach((line, i) => set(this.lines[i], { d: stage.linePath(line, modal) }));
    scene.nodes.forEach(({ point }, i) => {
      const [cx, cy] = stage.place(point, modal);
      set(this.dots[i], { cx, cy });
    });
    this.root.dataset.mode = String(this.chosen + 1);
  }
}
