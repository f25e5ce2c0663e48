// The structure moving against its stops, with a time line, a play button and a slider.

// The slider's thumb is this wide; the time line is inset by half of it, so that they line up.
const THUMB = 18;
const FLASHES = 20;

class Motion {
  constructor(root, scene) {
    this.root = root;
    this.scene = scene;
    this.last = scene.frames;
    this.duration = scene.duration;
    this.modes = scene.modal.length / (scene.frames + 1);
    this.frame = 0;
    this.playing = false;
    this.slowdown = scene.paces.choices[scene.paces.first].slowdown;
    this.largestForce = scene.forces.reduce((most, force) => Math.max(most, force), 0);
    const find = (name) => root.querySelector(`[data-part=${name}]`);
    this.button = find("play");
    this.slider = find("slider");
    this.readout = find("readout");
    this.strip = find("strip");
    this.stripHeight = root.classList.contains("upright") ? 150 : 84;
    this.stage = new Stage(find("stage"), scene);
    this.stage.magnification = scene.magnifications.choices[scene.magnifications.first];
    this.stage.reach(this.someMotions());
    this.setUpControls(find("speed"), find("magnify"), find("magnified"));
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

  forceAt(stop, frame) {
    return this.between(this.scene.forces, stop * (this.last + 1), 1, frame);
  }

  // As the table of impacts says, which a force does not: it is zero at the instant of closing.
  isClosed(stop, time) {
    return this.scene.contacts[stop].some(
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
    const { forces, frames } = this.scene;
    let best = 0;
    for (let i = 1; i < forces.length; i += 1) if (forces[i] > forces[best]) best = i;
    return best % (frames + 1);
  }

  layOut() {
    const width = roomWithin(this.stage.element.parentElement);
    if (width === 0) return;
    this.stage.fit(width, this.scene.lines.length ? 400 : 320);
    this.drawStage();
    this.drawStrip();
    this.show();
  }

  drawStage() {
    const { stage, scene } = this;
    stage.element.replaceChildren();
    const fixed = svg("g", {}, stage.element);
    stage.drawFixedParts(fixed);
    this.drawGhosts(fixed);
    this.stops = scene.stops.map((stop) => this.drawStop(stop));
    this.lines = scene.lines.map(() => svg("path", { class: "beam" }, stage.element));
    this.nodes = scene.nodes.map(({ name, point }) => {
      const body = scene.bodies.includes(point);
      const radius = body ? BODY_RADIUS : 4;
      const dot = svg("circle", { class: body ? "body" : "node", r: radius }, stage.element);
      dot.dataset.node = name;
      return dot;
    });
    this.labels = scene.nodes.map(({ name, point }) => this.drawLabel(name, point));
    this.arrows = scene.stops.map(() => svg("path", { class: "force" }, stage.element));
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

  // A beam's labels stay where its nodes are at rest; a body's go with it.
  drawLabel(name, point) {
    const stopped = this.scene.stops.some((stop) => stop.point === point);
    const sideways = this.scene.stops.some(
      (stop) => stop.point === point && Math.abs(stop.normal[0]) > 0.5,
    );
    const label = svg("text", { class: "label" }, this.stage.element);
    label.textContent = name;
    if (this.scene.bodies.includes(point)) {
      // Clear of the stop and of the arrow of its force.
      const [right, down] = sideways ? [-4, -BODY_RADIUS - 7] : [BODY_RADIUS + 8, 4];
      return { follow: ([x, y]) => set(label, { x: x + right, y: y + down }) };
    }
    const [x, y] = this.stage.rest(point);
    // Beside the arrow of the force, and beside a post, not on them.
    if (stopped) set(label, { x: x + 12, y: y - 10 });
    else if (this.stage.onlyPostsMeetAt(point)) set(label, { x: x + 14, y: y - 8 });
    else set(label, { x, y: y - 12, "text-anchor": "middle" });
    return { follow: () => {} };
  }

  drawStop(stop) {
    const { stage } = this;
    const length = Math.hypot(...stop.normal);
    // Seen from its front, a stop has no side to draw.
    if (length < 0.2) return null;
    const normal = [stop.normal[0] / length, -stop.normal[1] / length];
    const reach = this.scene.bodies.includes(stop.point) ? BODY_RADIUS : BEAM_HALF_WIDTH;
    const pixels = stage.scale * stage.magnification * length;
    const rest = stage.rest(stop.point);
    const away = (distance) => [
      rest[0] - normal[0] * distance,
      rest[1] - normal[1] * distance,
    ];
    const surface = stop.gap * pixels + reach;
    const ground = surface + stop.deepest * pixels + SHORTEST_SPRING;
    const group = svg("g", { class: "stop" }, stage.element);
    group.dataset.stop = stop.name;
    svg("path", { class: "ground", d: groundPath(away(ground), normal) }, group);
    this.drawStopLabel(group, stop.label, normal, away(ground), away(surface));
    return {
      group,
      normal,
      away,
      surface,
      ground,
      pixels,
      spring: svg("path", { class: "spring" }, group),
      plate: svg("path", { class: "plate" }, group),
    };
  }

  // Beside the ground of a spring that stands, under one that lies.
  drawStopLabel(group, text, normal, foot, surface) {
    const label = svg("text", { class: "label" }, group);
    label.textContent = text;
    const left = foot[0] > this.stage.width / 2;
    if (Math.abs(normal[1]) > 0.5) {
      set(label, { x: foot[0] + (left ? -26 : 26), y: foot[1], "text-anchor": left ? "end" : "start" });
    } else {
      set(label, { x: (foot[0] + surface[0]) / 2, y: foot[1] + 38, "text-anchor": "middle" });
    }
    keepInside(label, this.stage.width);
  }

  showStop(index, drawn, modal) {
    if (!drawn) return;
    const { stage, scene } = this;
    const stop = scene.stops[index];
    const force = this.forceAt(index, this.frame);
    const [u, v] = stage.displacement(stop.point, modal);
    const along = u * stop.normal[0] + v * stop.normal[1];
    const squared = stop.normal[0] ** 2 + stop.normal[1] ** 2;
    const distance = stop.gap + along / squared;
    const closed = this.isClosed(index, this.timeAt(this.frame));
    const pressed = closed ? Math.max(0, -distance) * drawn.pixels : 0;
    const at = drawn.away(drawn.surface + pressed);
    const across = [-drawn.normal[1] * 14, drawn.normal[0] * 14];
    set(drawn.spring, { d: springPath(at, drawn.away(drawn.ground)) });
    set(drawn.plate, {
      d: pathThrough([
        [at[0] - across[0], at[1] - across[1]],
        [at[0] + across[0], at[1] + across[1]],
      ]),
    });
    drawn.group.dataset.contact = closed ? "closed" : "open";
    this.showForce(this.arrows[index], drawn, at, force / this.largestForce);
  }

  // The force on the structure, as an arrow that ends at the far side of what it pushes.
  showForce(arrow, { normal, surface }, at, share) {
    // Nothing but rounding, or a stop that never pushes for a while.
    if (!(share > 1e-9)) {
      arrow.setAttribute("d", "");
      return;
    }
    const start = 2 * (this.scene.lines.length ? BEAM_HALF_WIDTH : BODY_RADIUS) + 3;
    const length = 14 + 38 * share;
    const point = (distance, side) => [
      at[0] + normal[0] * distance - normal[1] * side,
      at[1] + normal[1] * distance + normal[0] * side,
    ];
    const tip = start + length;
    const head = pathThrough([point(tip - 8, -5), point(tip, 0), point(tip - 8, 5)]);
    arrow.setAttribute("d", pathThrough([point(start, 0), point(tip, 0)]) + head);
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
    for (const [start, end] of this.scene.contacts.flat().sort(([one], [other]) => one - other)) {
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
      this.labels[i].follow([cx, cy]);
    });
    this.stops.forEach((drawn, i) => this.showStop(i, drawn, modal));
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
    const forces = scene.stops.map((_, stop) => this.forceAt(stop, frame));
    const closed = scene.stops.some((_, stop) => this.isClosed(stop, time));
    this.watchedRange ??= scene.watched.values.reduce((most, v) => Math.max(most, Math.abs(v)), 0);
    const told = {
      time: `${steady(time * clock, this.duration * clock)} ${clockUnit}`,
      value: `${steady(value * factor, this.watchedRange * factor)} ${unit}`,
      contact: closed ? "in contact" : "free",
    };
    if (forces.length) {
      const force = steady(Math.max(...forces) * newton, this.largestForce * newton);
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
