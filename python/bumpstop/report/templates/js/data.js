// Reads what Python wrote: plain JSON, with arrays as base64 (plotly's own form of them).

function decodeArray({ dtype, bdata }) {
  const bytes = Uint8Array.from(atob(bdata), (letter) => letter.charCodeAt(0));
  return dtype === "i4" ? new Int32Array(bytes.buffer) : new Float32Array(bytes.buffer);
}

function decode(value) {
  if (value === null || typeof value !== "object") return value;
  if ("bdata" in value) return decodeArray(value);
  if (Array.isArray(value)) return value.map(decode);
  return Object.fromEntries(Object.entries(value).map(([key, part]) => [key, decode(part)]));
}

function readData() {
  return JSON.parse(document.getElementById("report-data").textContent);
}

// A number to so many significant digits, with a true minus sign.
function significant(value, digits = 4) {
  if (!Number.isFinite(value)) return "–";
  if (Math.abs(value) < 1e-12) return "0";
  const text =
    Math.abs(value) >= 10 ** digits ? value.toFixed(0) : Number(value).toPrecision(digits);
  return text.includes("e") ? String(Number(text)).replace("-", "−") : text.replace("-", "−");
}

// A number with a fixed count of decimals that suits a range, so that a readout does not jitter.
function steady(value, range, digits = 4) {
  const whole = range > 0 ? Math.floor(Math.log10(range)) + 1 : 1;
  const text = value.toFixed(Math.min(Math.max(digits - whole, 0), 9));
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}
