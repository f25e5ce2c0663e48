// The structure moving against its stops, with a time line, a play button and a slider.

// The slider's thumb is this wide; the time line is inset by half of it, so that they line up.
const THUMB = 18;
const FLASHES = 20;
// Labels closer than this, in pixels, would lie over each other.
const NEAR = 14;

class Motion {
  constructor(root, scene) {
    this.root = root;
    this.table = scene.vertical ? new Turntable(scene) : null;
    this.scene = this.table ? this.table.onPaper() : scene;
    this.last = scene.frames;
    this.duration = scene.duration;
    this.modes = scene.modal.length / (scene.frames + 1);
    this.frame = 0;
    this.playing = false;
    this.slowdown = scene.paces.choices[scene.paces.first].slowdown;
    this.largestForce = Math.max(...scene.laws.map(({ forces }) => largestOf(forces)), 0);
    const find = (name) => root.querySelector(`[data-part=${name}]`);
    this.button = find("play");
    this.slider = find("slider");
    this.readout = find("readout");
    this.strip = find("strip");
    this.stripHeight = root.classList.contains("upright") ? 150 : 84;
    this.stage = new Stage(find("stage"), this.scene);
    this.stage.magnification = scene.magnifications.choices[scene.magnifications.first];
    this.stage.reach(this.someMotions());
    const orbits = find("orbits");
    this.orbits = scene.laws.flatMap((law, i) => (law.orbit ? [new Orbit(law, i, orbits)] : []));
    this.setUpControls(find("speed"), find("magnify"), find("magnified"));
    if (this.table) letTurn(this.stage.element, (...by) => this.turn(...by));
    new ResizeObserver(() => this.layOut()).observe(root);
    this.layOut();
  }

  someMotions() {
    const stride = Math.max(1, Math.floor(this.last / 400));
    const motions = [];
    for (let frame = 0; frame <= this.last; frame += stride) motions.push(this.modalAt(frame));
    return motions;
  }

  setUpControls(speed, magnify, magnified) {
    this.button.addEventListener("click", () => (this.playing ? this.pause() : this.play()));
    this.slider.max = String(this.last);
    this.slider.addEventListener("input", () => {
      this.pause();
      this.seek(Number(this.slider.value));
    });
    speed.addEventListener("change", () => {
      this.slowdown = this.scene.paces.choices[speed.selectedIndex].slowdown;
    });
    if (magnify) {
      magnify.addEventListener("input", () => {
        const factor = this.scene.magnifications.choices[Number(magnify.value)];
        this.stage.magnification = factor;
        magnified.textContent = `× ${factor.toLocaleString("en")}`;
        magnify.setAttribute("aria-valuetext", `${factor} times`);
        this.layOut();
      });
    }
    const seekAt = (event) => {
      const box = this.strip.getBoundingClientRect();
      const share = (event.clientX - box.left - THUMB / 2) / (box.width - THUMB);
      this.pause();
      this.seek(Math.min(Math.max(share, 0), 1) * this.last);
    };
    this.strip.addEventListener("pointerdown", (event) => {
      this.strip.setPointerCapture(event.pointerId);
      seekAt(event);
    });
    this.strip.addEventListener("pointermove", (event) => {
      if (event.buttons) seekAt(event);
    });
  }

  turn(azimuth, tilt) {
    this.table.turn(azimuth, tilt);
    this.scene = this.table.onPaper();
    this.stage.scene = this.scene;
    this.stage.reach(this.someMotions());
    this.layOut();
  }

  play() {
    if (this.frame >= this.last) this.seek(0);
    this.setPlaying(true);
    this.before = null;
    requestAnimationFrame((now) => this.tick(now));
  }

  pause() {
    this.setPlaying(false);
  }

  setPlaying(playing) {
    this.playing = playing;
    this.button.dataset.state = playing ? "playing" : "paused";
    this.button.querySelector("span").textContent = playing ? "Pause" : "Play";
  }

  tick(now) {
    if (!this.playing) return;
    if (this.root.offsetWidth === 0) {
      this.pause();
      return;
    }
    const elapsed = this.before === null ? 0 : (now - this.before) / 1000;
    this.before = now;
    const frames = (elapsed / this.slowdown / this.duration) * this.last;
    this.seek(Math.min(this.frame + frames, this.last));
    if (this.frame >= this.last) this.pause();
    else requestAnimationFrame((next) => this.tick(next));
  }

  // Linear between two frames, which stand close enough for that.
  between(values, offset, stride, frame) {
    const low = Math.min(Math.floor(frame), this.last - 1);
    const share = frame - low;
    const at = offset + low * stride;
    return values[at] * (1 - share) + values[at + stride] * share;
  }

  modalAt(frame) {
    const modal = new Float64Array(this.modes);
    for (let mode = 0; mode < this.modes; mode += 1) {
      modal[mode] = this.between(this.scene.modal, mode, this.modes, frame);
    }
    return modal;
  }

  forceAt(law, frame) {
    return this.between(this.scene.laws[law].forces, 0, 1, frame);
  }

  // As the table of impacts says, which a force does not: it is zero at the instant of closing.
  isClosed(stop, time) {
    return this.scene.laws[stop].contacts.some(
      ([start, end]) => start <= time && (time < end || end === this.duration),
    );
  }

  timeAt(frame) {
    return (this.duration * frame) / this.last;
  }

  seek(frame) {
    this.frame = frame;
    this.show();
  }

  // On paper nothing moves: show the hardest contact.
  setPrinting(printing) {
    this.pause();
    if (printing) {
      this.frameBefore ??= this.frame;
      this.frame = this.hardestFrame();
    } else if (this.frameBefore !== undefined) {
      this.frame = this.frameBefore;
      delete this.frameBefore;
    }
    this.layOut();
  }

  hardestFrame() {
    let [best, most] = [0, 0];
    for (const { forces } of this.scene.laws) {
      forces.forEach((force, frame) => {
        if (Math.abs(force) > most) [best, most] = [frame, Math.abs(force)];
      });
    }
    return best;
  }

  layOut() {
    const width = roomWithin(this.stage.element.parentElement);
    if (width === 0) return;
    this.stage.fit(width, this.scene.lines.length ? 400 : 320);
    this.drawStage();
    this.orbits.forEach((orbit) => orbit.layOut(this, Math.min(width, 240)));
    this.drawStrip();
    this.show();
  }

  drawStage() {
    const { stage, scene } = this;
    stage.element.replaceChildren();
    const fixed = svg("g", {}, stage.element);
    stage.drawFixedParts(fixed);
    this.drawGhosts(fixed);
    const drawings = makeDrawings(scene, stage);
    this.springs = drawings.slice(0, scene.springs.length);
    this.laws = drawings.slice(scene.springs.length);
    this.lines = scene.lines.map(() => svg("path", { class: "beam" }, stage.element));
    this.nodes = scene.nodes.map(({ name, point }) => {
      const body = scene.bodies.includes(point);
      const radius = body ? BODY_RADIUS : 4;
      const dot = svg("circle", { class: body ? "body" : "node", r: radius }, stage.element);
      dot.dataset.node = name;
      return dot;
    });
    this.labels = this.sharedNames().map(({ names, point }) => this.drawLabel(names, point));
    this.laws.forEach((drawing) => drawing.addArrow());
  }

  // Where the structure is at equal intervals, as in a photograph under a strobe lamp.
  drawGhosts(group) {
    for (let flash = 0; flash <= FLASHES; flash += 1) {
      const modal = this.modalAt((this.last * flash) / FLASHES);
      for (const line of this.scene.lines) {
        svg("path", { class: "ghost", d: this.stage.linePath(line, modal) }, group);
      }
    }
  }

  // Nodes that rest at one place share a label, which is that of a body if one is there.
  sharedNames() {
    const shared = [];
    const { nodes, bodies } = this.scene;
    for (const { name, point } of nodes) {
      const here = this.stage.rest(point);
      const known = shared.find(({ point: other }) => {
        const there = this.stage.rest(other);
        return Math.hypot(here[0] - there[0], here[1] - there[1]) < NEAR;
      });
      if (!known) shared.push({ names: name, point });
      else {
        known.names += `, ${name}`;
        if (bodies.includes(point)) known.point = point;
      }
    }
    return shared;
  }

  // A beam's labels stay where its nodes are at rest; a body's go with it.
  drawLabel(name, point) {
    const acting = this.scene.laws.filter((law) => law.point === point);
    const stopped = acting.length > 0;
    const sideways = acting.some((law) => Math.abs(law.normal[0]) > 0.5);
    const label = svg("text", { class: "label" }, this.stage.element);
    label.textContent = name;
    if (this.scene.bodies.includes(point)) {
      // Clear of the stop and of the arrow of its force.
      const [right, down] = sideways ? [-4, -BODY_RADIUS - 7] : [BODY_RADIUS + 8, 4];
      return { point, follow: ([x, y]) => set(label, { x: x + right, y: y + down }) };
    }
    const [x, y] = this.stage.rest(point);
    // Beside the arrow of the force, and beside a post, not on them.
    if (stopped) set(label, { x: x + 12, y: y - 10 });
    else if (this.stage.onlyPostsMeetAt(point)) set(label, { x: x + 14, y: y - 8 });
    else set(label, { x, y: y - 12, "text-anchor": "middle" });
    keepInside(label, this.stage.width);
    return { point, follow: () => {} };
  }

  drawStrip() {
    const { strip, scene } = this;
    const width = roomWithin(this.strip.parentElement);
    const { values } = scene.watched;
    const inner = width - THUMB;
    let [low, high] = [0, 0];
    for (const value of values) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
    const x = (frame) => THUMB / 2 + (inner * frame) / this.last;
    const y = (value) => 8 + ((this.stripHeight - 16) * (high - value)) / (high - low || 1);
    this.stripX = x;
    this.stripY = y;
    strip.replaceChildren();
    setSize(strip, width, this.stripHeight);
    for (const [start, end] of this.closedSpans()) {
      const [left, right] = [start, end].map((time) => x((this.last * time) / this.duration));
      const band = { x: left, width: Math.max(right - left, 1), y: 0, height: this.stripHeight };
      svg("rect", { class: "contact-band", ...band }, strip);
    }
    svg("path", { class: "zero-line", d: pathThrough([[x(0), y(0)], [x(this.last), y(0)]]) }, strip);
    const curve = Array.from(values, (value, frame) => [x(frame), y(value)]);
    svg("path", { class: "watched-line", d: pathThrough(curve) }, strip);
    this.cursor = svg("line", { class: "cursor", y1: 0, y2: this.stripHeight }, strip);
    this.dot = svg("circle", { class: "cursor-dot", r: 4.5 }, strip);
  }

  // Stretches of time in which any stop is closed.
  closedSpans() {
    const spans = [];
    const contacts = this.scene.laws.flatMap((law) => law.contacts);
    for (const [start, end] of contacts.sort(([one], [other]) => one - other)) {
      const before = spans.at(-1);
      if (before && start <= before[1]) before[1] = Math.max(before[1], end);
      else spans.push([start, end]);
    }
    return spans;
  }

  show() {
    if (!this.lines) return;
    const { scene, stage, frame } = this;
    const modal = this.modalAt(frame);
    stage.moveRollers(modal);
    scene.lines.forEach((line, i) => set(this.lines[i], { d: stage.linePath(line, modal) }));
    scene.nodes.forEach(({ point }, i) => {
      const [cx, cy] = stage.place(point, modal);
      set(this.nodes[i], { cx, cy });
    });
    this.labels.forEach(({ point, follow }) => follow(stage.place(point, modal)));
    this.springs.forEach((drawing) => drawing.show(this, -1, modal));
    this.laws.forEach((drawing, i) => drawing.show(this, i, modal));
    this.orbits.forEach((orbit) => orbit.show(this));
    const value = this.between(scene.watched.values, 0, 1, frame);
    const x = this.stripX(frame);
    set(this.cursor, { x1: x, x2: x });
    set(this.dot, { cx: x, cy: this.stripY(value) });
    this.tell(value);
  }

  tell(value) {
    const { scene, frame } = this;
    const time = this.timeAt(frame);
    const [clock, clockUnit] = scene.timeScale;
    const [factor, unit] = scene.watched.scale;
    const [newton, newtonUnit] = scene.forceScale;
    const forces = scene.laws.map((_, law) => this.forceAt(law, frame));
    const closed = scene.laws.some((_, law) => this.isClosed(law, time));
    this.watchedRange ??= scene.watched.values.reduce((most, v) => Math.max(most, Math.abs(v)), 0);
    const told = {
      time: `${steady(time * clock, this.duration * clock)} ${clockUnit}`,
      value: `${steady(value * factor, this.watchedRange * factor)} ${unit}`,
      contact: closed ? "in contact" : "free",
    };
    if (forces.length) {
      const largest = forces.reduce((a, b) => (Math.abs(b) > Math.abs(a) ? b : a), 0);
      const force = steady(largest * newton, this.largestForce * newton);
      told.force = `${force} ${newtonUnit}`;
    }
    for (const [name, text] of Object.entries(told)) {
      const place = this.readout.querySelector(`[data-value=${name}]`);
      if (place) place.textContent = text;
    }
    this.root.dataset.contact = closed ? "closed" : "open";
    this.root.dataset.time = String(time);
    this.slider.value = String(Math.round(frame));
    this.slider.setAttribute("aria-valuetext", Object.values(told).join(", "));
  }
}

function largestOf(values) {
  return values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
}
