// Draws the charts of a page. The page holds them as JSON in the element #charts: a list of
// { id, x, y, loop, traces: [{ name, x, y, kind }], bands: [{ name, x, low, high, outer }] }.
// plotly.js gives hover, zoom by dragging (double click: back) and the toolbar.
"use strict";

const colours = ["#0b5cad", "#d1495b", "#2e8b57", "#8a5a9e", "#c77d0a", "#3aa0a8", "#6b7480", "#a23b72",
                 "#7a8b1c", "#444444", "#1f9e89", "#e07a5f"];

// a corridor: its lower edge, and its upper edge filled down to it
function bandTraces(band) {
  const edge = { mode: "lines", line: { width: 0.7, color: "#7c8794" }, legendgroup: band.name };
  return [
    { ...edge, name: band.name + ", low", x: band.x, y: band.low, showlegend: false },
    { ...edge, name: band.name, x: band.x, y: band.high, fill: "tonexty",
      fillcolor: band.outer ? "rgba(124,135,148,0.12)" : "rgba(46,139,87,0.20)" },
  ];
}

function curveTrace(trace, index) {
  const colour = colours[index % colours.length];
  if (trace.kind === "points")
    return { type: "scatter", mode: "markers", name: trace.name, x: trace.x, y: trace.y, text: trace.text,
             marker: { color: colour, size: 8 } };
  return { type: "scatter", mode: "lines", name: trace.name, x: trace.x, y: trace.y,
           line: { color: colour, width: 2, dash: trace.kind === "dashed" ? "dash" : "solid" } };
}

function draw(chart) {
  const traces = chart.bands.flatMap(bandTraces).concat(chart.traces.map(curveTrace));
  const layout = {
    margin: { l: 70, r: 15, t: 15, b: 50 },
    hovermode: chart.loop ? "closest" : "x unified",
    xaxis: { title: { text: chart.x }, zeroline: false },
    yaxis: { title: { text: chart.y }, zeroline: false },
    legend: { orientation: "h", y: 1.12 },
    showlegend: traces.length > 1,
  };
  Plotly.newPlot(chart.id, traces, layout, { responsive: true, displaylogo: false });
}

document.addEventListener("DOMContentLoaded", () => {
  const holder = document.getElementById("charts");
  if (holder) JSON.parse(holder.textContent).forEach(draw);
});
