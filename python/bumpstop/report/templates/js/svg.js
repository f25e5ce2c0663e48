// Small helpers to draw SVG.

function svg(name, attributes = {}, parent = null) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  set(element, attributes);
  if (parent) parent.append(element);
  return element;
}

function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    element.setAttribute(name, typeof value === "number" ? Number(value.toFixed(3)) : value);
  }
}

// A size in pixels that shrinks as a whole where there is less room than that.
function setSize(element, width, height) {
  set(element, { width, height, viewBox: `0 0 ${width} ${height}` });
}

function pathThrough(points) {
  return points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(2)} ${y.toFixed(2)}`).join("");
}

// A coil spring from one point to another, as a zigzag with straight ends.
function springPath(from, to, coils = 5, halfWidth = 8) {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const length = Math.hypot(dx, dy) || 1;
  const along = [dx / length, dy / length];
  const lead = Math.min(7, length / 5);
  const points = [from];
  for (let i = 0; i <= 2 * coils; i += 1) {
    const distance = lead + ((length - 2 * lead) * i) / (2 * coils);
    const side = i === 0 || i === 2 * coils ? 0 : i % 2 ? halfWidth : -halfWidth;
    points.push([
      from[0] + along[0] * distance - along[1] * side,
      from[1] + along[1] * distance + along[0] * side,
    ]);
  }
  points.push(to);
  return pathThrough(points);
}

// A cup with a plunger in it: a dashpot from one point to another.
function dashpotPath(from, to, halfWidth = 7) {
  const { at, length } = between(from, to);
  const cup = Math.min(24, 0.6 * length);
  const [start, end] = [(length - cup) / 2, (length + cup) / 2];
  const head = start + 0.45 * cup;
  return (
    pathThrough([at(0, 0), at(head, 0)]) +
    pathThrough([at(head, -halfWidth + 2), at(head, halfWidth - 2)]) +
    pathThrough([at(start, -halfWidth), at(end, -halfWidth), at(end, halfWidth), at(start, halfWidth)]) +
    pathThrough([at(end, 0), at(length, 0)])
  );
}

// A box on a line: whatever acts between two points.
function boxPath(from, to, halfWidth = 8) {
  const { at, length } = between(from, to);
  const box = Math.min(26, 0.6 * length);
  const [start, end] = [(length - box) / 2, (length + box) / 2];
  const corners = [[start, -halfWidth], [end, -halfWidth], [end, halfWidth], [start, halfWidth]];
  return (
    pathThrough([at(0, 0), at(start, 0)]) +
    `${pathThrough(corners.map(([along, side]) => at(along, side)))}Z` +
    pathThrough([at(end, 0), at(length, 0)])
  );
}

const WIDEST_BOW = 20;

// A slender post that bows sideways as it is shortened from its full length.
function strutPath(from, to, full) {
  const { at, length } = between(from, to);
  const bow = Math.min(3 + Math.sqrt(Math.max(full * full - length * length, 0)) / 2, WIDEST_BOW);
  const points = Array.from({ length: 17 }, (_, i) =>
    at((length * i) / 16, bow * Math.sin((Math.PI * i) / 16)),
  );
  return pathThrough(points);
}

// Points by their way along a line in the plane and beside it, in pixels.
function between(from, to) {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const length = Math.hypot(dx, dy) || 1;
  const along = [dx / length, dy / length];
  const at = (way, side) => [
    from[0] + along[0] * way - along[1] * side,
    from[1] + along[1] * way + along[0] * side,
  ];
  return { at, length };
}

// Rows of so many numbers each.
function rowsOf(values, size) {
  return Array.from({ length: values.length / size }, (_, i) =>
    Array.from(values.slice(i * size, (i + 1) * size)),
  );
}

// A line with hatching behind it: solid ground, its free side facing `normal`.
function groundPath(centre, normal, halfWidth = 20) {
  const along = [-normal[1], normal[0]];
  const at = (s, depth) => [
    centre[0] + along[0] * s - normal[0] * depth,
    centre[1] + along[1] * s - normal[1] * depth,
  ];
  let path = pathThrough([at(-halfWidth, 0), at(halfWidth, 0)]);
  for (let s = -halfWidth + 2; s <= halfWidth; s += 6) path += pathThrough([at(s, 0), at(s - 5, 7)]);
  return path;
}

// Shift a text sideways until it is wholly within a width.
function keepInside(text, width, margin = 6) {
  const box = text.getBBox();
  const shift =
    Math.max(0, margin - box.x) - Math.max(0, box.x + box.width - (width - margin));
  if (shift) set(text, { x: Number(text.getAttribute("x")) + shift });
}
