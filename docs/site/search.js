// The search box of the site: sections with all its words, or their beginnings, the best first. Loaded by each page.
(function () {
  "use strict";
  const box = document.getElementById("mkdocs-search-query");
  const list = document.getElementById("mkdocs-search-results");
  if (!box || !list) return;
  let ready = null;

  function load(name) {
    return new Promise(function (done, failed) {
      const script = document.createElement("script");
      script.src = base_url + "/search/" + name;
      script.onload = done;
      script.onerror = failed;
      document.head.append(script);
    });
  }

  async function prepare() {
    await load("lunr.js");
    await load("search_index.js");
    const sections = new Map(searchIndex.docs.map((section) => [section.location, section]));
    const index = lunr(function () {
      this.ref("location");
      this.field("title", { boost: 10 });
      this.field("text");
      searchIndex.docs.forEach((section) => this.add(section));
    });
    return { index, sections };
  }

  function entry(section, word) {
    const at = Math.max(0, section.text.toLowerCase().indexOf(word) - 60);
    const link = document.createElement("a");
    link.href = base_url + "/" + section.location;
    link.textContent = section.title;
    const heading = document.createElement("h3");
    heading.append(link);
    const text = document.createElement("p");
    text.textContent = section.text.slice(at, at + 200);
    const article = document.createElement("article");
    article.append(heading, text);
    return article;
  }

  async function search() {
    const words = box.value.toLowerCase().split(/[^\p{L}\p{N}_]+/u).filter((word) => word.length > 1);
    if (!ready) ready = prepare();
    const { index, sections } = await ready;
    const found = words.length ? index.search(words.map((word) => word + " " + word + "*").join(" ")) : [];
    const all = found.filter(function (hit) {
      const section = sections.get(hit.ref);
      const text = (section.title + " " + section.text).toLowerCase();
      return words.every((word) => text.includes(word));
    });
    const shown = (all.length ? all : found).slice(0, 30).map((hit) => entry(sections.get(hit.ref), words[0]));
    list.replaceChildren(...shown);
    if (!shown.length && words.length) list.textContent = "Nothing was found.";
  }

  box.addEventListener("input", search);
})();
