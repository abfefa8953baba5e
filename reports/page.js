// Sorts a table by the column whose heading is pressed: numbers by their value, texts by the alphabet, dashes last.
const superscript = "⁰¹²³⁴⁵⁶⁷⁸⁹";
function valueOf(cell) {
  const text = cell.textContent.trim();
  if (text === "" || text === "–") return null;
  const plain = text.replace(/−/g, "-").replace(/^[±+]/, "").replace(/²$/, "").replace(/×10(⁻?)([⁰¹²³⁴⁵⁶⁷⁸⁹]+)/,
    (all, sign, digits) => "e" + (sign ? "-" : "") + [...digits].map(digit => superscript.indexOf(digit)).join(""));
  const number = parseFloat(plain);
  return /^-?[\d.]/.test(plain) && !Number.isNaN(number) ? number : text;
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
