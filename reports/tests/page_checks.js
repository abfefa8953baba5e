// What a reader may expect of the page, as far as only a browser can tell. Each check of the page answers with
// { seen: how many things it judged, bad: [what is wrong] }.
globalThis.checks = (() => {
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const name = (element) => element.tagName.toLowerCase() + (element.id && "#" + element.id)
    + (element.classList.length ? "." + element.classList[0] : "")
    + " “" + element.textContent.trim().replace(/\s+/g, " ").slice(0, 40) + "”";
  const visible = (element) => {
    const box = element.getBoundingClientRect();
    return element.checkVisibility({ visibilityProperty: true }) && box.width > 1 && box.height > 1;
  };
  const verdict = (elements, wrong) => {
    const bad = elements.map((element) => [element, wrong(element)]).filter(([, why]) => why);
    return { seen: elements.length, bad: bad.map(([element, why]) => name(element) + ": " + why) };
  };

  // Figures without words for those who do not see them. What is no figure may be hidden from them instead.
  function alternatives() {
    const drawings = all("svg, img, canvas, object, embed").filter((each) => !each.parentElement.closest("svg"));
    return verdict(drawings, (each) => {
      const words = each.tagName === "IMG" ? each.alt : each.getAttribute("aria-label");
      if (!each.closest("figure") && each.getAttribute("aria-hidden") === "true") return "";
      if (!words || !words.trim()) return "no alternative text";
      return each.tagName === "IMG" || each.getAttribute("role") === "img" ? "" : "its role is not img";
    });
  }

  // What reaches over the screen's right edge, unless it scrolls in a box of its own, which fits.
  function width() {
    const screen = document.documentElement.clientWidth, scrolled = document.scrollingElement.scrollWidth;
    const scrolls = (each) => ["auto", "scroll"].includes(getComputedStyle(each).overflowX);
    const held = (each) => {
      for (let box = each.parentElement; box && box !== document.body; box = box.parentElement) if (scrolls(box)) return true;
      return false;
    };
    const boxes = all("body *").filter((each) => !each.parentElement.closest("svg") && visible(each) && !held(each));
    const found = verdict(boxes, (each) => {
      const right = each.getBoundingClientRect().right;
      return right <= screen + 0.5 ? "" : `ends at ${Math.round(right)} of ${screen} pixels`;
    });
    if (scrolled > screen) found.bad.unshift(`the page is ${scrolled} pixels wide on a screen of ${screen}`);
    return found;
  }

  // Drawings whose text, of 7 points and more, a small screen would shrink below 7 pixels. Their unit is a point.
  function legible() {
    return verdict(all(".drawn svg").filter(visible), (each) => {
      const scale = each.getBoundingClientRect().width / each.viewBox.baseVal.width;
      return scale >= 1 ? "" : `${scale.toFixed(2)} pixels to the point`;
    });
  }

  // Colours as they are painted: any notation, alpha from 0 to 1.
  const painter = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  const known = new Map();
  function paint(colour) {
    if (!known.has(colour)) {
      painter.clearRect(0, 0, 1, 1);
      painter.fillStyle = colour;
      painter.fillRect(0, 0, 1, 1);
      const [red, green, blue, alpha] = painter.getImageData(0, 0, 1, 1).data;
      known.set(colour, [red, green, blue, alpha / 255]);
    }
    return known.get(colour);
  }
  const over = (front, back) => back.map((value, i) => front[3] * front[i] + (1 - front[3]) * value);
  const light = (colour) => {
    const [red, green, blue] = colour.map((value) => value / 255).map(
      (value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4));
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  };
  const contrast = (one, other) => {
    const [dark, bright] = [light(one), light(other)].sort((a, b) => a - b);
    return (bright + 0.05) / (dark + 0.05);
  };

  // The colour behind what stands in an element, from the screen's own forwards.
  function background(element) {
    const probe = document.body.appendChild(document.createElement("div"));
    probe.style.background = "Canvas";
    probe.style.colorScheme = getComputedStyle(document.documentElement).colorScheme;
    let behind = paint(getComputedStyle(probe).backgroundColor).slice(0, 3);
    probe.remove();
    const chain = [];
    for (let box = element; box; box = box.parentElement) chain.unshift(getComputedStyle(box));
    for (const style of chain) behind = over(paint(style.backgroundColor), behind);
    return behind;
  }

  // Text against its background (WCAG 2.2, 1.4.3): 4.5, large text 3.
  function text() {
    const places = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    const elements = new Set();
    while (places.nextNode()) {
      const place = places.currentNode.parentElement;
      if (places.currentNode.data.trim() && !place.closest("svg, script, style") && visible(place)) elements.add(place);
    }
    return verdict([...elements], (each) => {
      const style = getComputedStyle(each), size = parseFloat(style.fontSize);
      const least = size >= 24 || (size >= 18.66 && style.fontWeight >= 700) ? 3 : 4.5;
      let opacity = 1;
      for (let box = each; box; box = box.parentElement) {
        const found = getComputedStyle(box);
        opacity *= found.opacity;
        if (found.backgroundImage !== "none") return "stands on a picture";
      }
      const behind = background(each), [red, green, blue, alpha] = paint(style.color);
      const found = contrast(over([red, green, blue, alpha * opacity], behind), behind);
      return found >= least ? "" : `contrast ${found.toFixed(2)} of ${least}`;
    });
  }

  function headings() {
    const found = all("h1, h2, h3, h4, h5, h6");
    const level = (each) => +each.tagName[1];
    return verdict(found, (each) => {
      const before = found[found.indexOf(each) - 1];
      if (!each.textContent.trim()) return "is empty";
      if (!before) return level(each) === 1 ? "" : "comes before any h1";
      if (level(each) === 1) return "is a second h1";
      return level(each) <= level(before) + 1 ? "" : `follows ${name(before)}`;
    });
  }

  // Links to places of the page. What a drawing refers to by its name must be there once, or alike each time.
  function anchors() {
    const links = verdict(all("a[href^='#']"), (each) => {
      const target = each.getAttribute("href").slice(1);
      return document.querySelectorAll("#" + CSS.escape(target)).length === 1 ? "" : "leads to no place, or to several";
    });
    const referred = new Set(document.body.innerHTML.match(/(?<=url\(#|xlink:href="#)[^")]+/g));
    for (const each of referred) {
      const places = new Set(all("#" + CSS.escape(each)).map((place) => place.outerHTML));
      if (places.size !== 1) links.bad.push(`a drawing refers to #${each}, of which there are ${places.size}`);
    }
    return links;
  }

  // A click on the middle of what may be clicked must not land on something above it.
  function reachable() {
    return verdict(all("button, summary").filter(visible), (each) => {
      each.scrollIntoView({ block: "center", inline: "center", behavior: "instant" });
      const box = each.getBoundingClientRect();
      const hit = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
      return each.contains(hit) ? "" : `is covered by ${hit ? name(hit) : "nothing"}`;
    });
  }

  // A column of a sortable table: its cells and the rows, top down, and what each header says of the order.
  const spaced = (element) => element.textContent.trim().replace(/\s+/g, " ");
  const head = (table) => [...table.tHead.rows[0].cells];
  function column(table, index) {
    const rows = [...table.tBodies].flatMap((body) => [...body.rows]);
    return {
      cells: rows.map((row) => spaced(row.cells[index])), rows: rows.map(spaced), column: index,
      sorts: head(table).map((cell) => cell.getAttribute("aria-sort")),
    };
  }
  // Each column as it is, after a click on its header, and after a second.
  const clicked = () => all("table.sortable").flatMap((table) => head(table).flatMap((cell, index) => {
    const press = cell.querySelector("button");
    if (!press) return [];
    const states = [column(table, index)];
    for (let times = 0; times < 2; ++times) {
      press.click();
      states.push(column(table, index));
    }
    return [states];
  }));
  // The first header that sorts takes the focus; its column, and whether it has the focus.
  const first = () => document.querySelector("table.sortable th button");
  const focus = () => first().focus();
  const focused = () => Object.assign(column(first().closest("table"), first().closest("th").cellIndex),
    { focused: document.activeElement === first() });
  // Are texts in the order of the alphabet, or in that of their numbers?
  const alphabetical = (texts, sign) => [{}, { numeric: true }].some((options) => texts.every(
    (each, i) => i === 0 || sign * texts[i - 1].localeCompare(each, undefined, options) <= 0));

  return { alternatives, width, legible, text, headings, anchors, reachable, clicked, focus, focused,
    alphabetical, canvases: () => all("body, .drawn").map((each) => light(background(each))) };
})();
