// What is drawn for paper: it has another width than the window, which nothing may exceed, or
// the browser makes the whole page smaller.

// Between the margins of A4, in CSS pixels.
const PAPER_WIDTH = 660;

const paper = window.matchMedia("print");
let printing = false;

function isPrinting() {
  return printing || paper.matches;
}

// The width that a drawing has within an element, in pixels; 0 while that is hidden.
function roomWithin(element) {
  return isPrinting() ? PAPER_WIDTH : element.clientWidth;
}
