// Sorts a table by the column whose heading is pressed: numbers by their value, texts by the alphabet, dashes last.
const superscript = "⁰¹²³⁴⁵⁶⁷⁸⁹";
const scale = { M: 1e6, k: 1e3, m: 1e-3, µ: 1e-6, n: 1e-9, p: 1e-12 };
const written = /^\+?(-?\d+(?:\.\d+)?(?:e[-+]?\d+)?)(?:×10(⁻?)([⁰¹²³⁴⁵⁶⁷⁸⁹]+))?(?:\s([Mkmµnp])?(?:rad|N m|m|Pa|J|s)\b)?/;
function valueOf(cell) {
  const text = cell.textContent.trim();
  if (text === "" || text === "–") return null;
  const found = text.replace(/−/g, "-").match(written);
  if (!found) return text;
  const [, mantissa, sign, digits = "", prefix] = found;
  const power = [...digits].map(digit => superscript.indexOf(digit)).join("") || 0;
  return mantissa * 10 ** (sign ? -power : +power) * (scale[prefix] ?? 1);
}
function compare(one, other) {
  if (typeof one === typeof other) return typeof one === "number" ? one - other : one.localeCompare(other);
  return typeof one === "number" ? -1 : 1;
}
for (const button of document.querySelectorAll("table.sortable th button")) {
  button.addEventListener("click", () => {
    const head = button.closest("th"), body = button.closest("table").tBodies[0];
    const column = [...head.parentNode.children].indexOf(head);
    const way = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
    for (const other of head.parentNode.children) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", way > 0 ? "ascending" : "descending");
    const rows = [...body.rows].map(row => [valueOf(row.cells[column]), row]);
    rows.sort(([one], [other]) => one === null ? (other === null ? 0 : 1) : other === null ? -1 : way * compare(one, other));
    body.append(...rows.map(([, row]) => row));
  });
}
// What a link leads to is open.
function unfold() {
  const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  for (let at = target; at; at = at.parentElement) if (at.tagName === "DETAILS") at.open = true;
}
addEventListener("hashchange", unfold);
addEventListener("beforeprint", () => document.querySelectorAll("details.how").forEach(each => { each.open = true; }));
unfold();
