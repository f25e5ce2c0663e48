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
