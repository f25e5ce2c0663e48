// Light or dark, as the reader's system says; always light on paper.

const darkScreen = window.matchMedia("(prefers-color-scheme: dark)");

// Figures come in the colours of light paper; swap each for that of the theme in use.
function recoloured(figure, themes) {
  if (isPrinting() || !darkScreen.matches) return figure;
  const swap = new Map(
    Object.entries(themes.light).map(([role, colour]) => [colour, themes.dark[role]]),
  );
  const walk = (value) => {
    if (typeof value === "string") return swap.get(value) ?? value;
    if (value === null || typeof value !== "object" || "bdata" in value) return value;
    if (Array.isArray(value)) return value.map(walk);
    return Object.fromEntries(Object.entries(value).map(([key, part]) => [key, walk(part)]));
  };
  return walk(figure);
}
