// The plotly figures: drawn when they come into view, in the colours and width of the moment.

const PAPER_GUTTER = 24;

const plotConfig = {
  displaylogo: false,
  // Where nothing hovers plotly would show its tools for good, over the legend.
  displayModeBar: window.matchMedia("(hover: hover)").matches ? "hover" : false,
  responsive: true,
  // Named one by one: plotly's own set has one that sends the data to a server.
  modeBarButtons: [["toImage", "zoom2d", "pan2d", "resetScale2d"]],
};

// plotly is most of the page; it is read when the first figure comes into view, not before.
function loadPlotly() {
  if (window.Plotly) return;
  const script = document.createElement("script");
  script.textContent = document.getElementById("plotly").textContent;
  document.head.append(script);
}

class Plots {
  constructor(figures, themes, onDrawn) {
    this.onDrawn = onDrawn;
    this.figures = figures;
    this.themes = themes;
    this.places = [...document.querySelectorAll("[data-figure]")];
    this.drawn = new Set();
    this.watcher = new IntersectionObserver((entries) => this.onSeen(entries), {
      rootMargin: "400px",
    });
    this.places.forEach((place) => this.watcher.observe(place));
  }

  onSeen(entries) {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting || target.offsetWidth === 0) continue;
      this.watcher.unobserve(target);
      this.draw(target);
    }
  }

  draw(place) {
    loadPlotly();
    const { data, layout } = recoloured(this.figures[place.dataset.figure], this.themes);
    const fitted = { ...layout, ...this.fit(place) };
    if (window.matchMedia("(pointer: coarse)").matches) fitted.dragmode = false;
    Plotly.react(place, data, fitted, plotConfig);
    if (!this.drawn.has(place)) this.onDrawn(place);
    this.drawn.add(place);
  }

  fit(place) {
    if (isPrinting()) return this.fitPaper(place);
    return { autosize: true, font: this.font(place, place.offsetWidth < 460 ? 11 : 12.5) };
  }

  fitPaper(place) {
    const inPairs = place.closest(".figures") && !place.closest("figure:last-child:nth-child(odd)");
    const width = inPairs ? (PAPER_WIDTH - PAPER_GUTTER) / 2 : PAPER_WIDTH;
    return { autosize: false, width, height: inPairs ? 230 : 270, font: this.font(place, 10) };
  }

  font(place, size) {
    const style = getComputedStyle(document.documentElement);
    const color = style.getPropertyValue("--ink").trim();
    return { ...this.figures[place.dataset.figure].layout.font, color, size };
  }

  redraw() {
    const places = isPrinting() ? this.places : [...this.drawn];
    places.forEach((place) => this.draw(place));
  }
}
