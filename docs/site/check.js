// SPDX-License-Identifier: Apache-2.0
//
// Opens the pages of a site one after the other in a frame and writes into the title what is broken:
// pictures that do not load, links to pages or places that are not there, pages without text.  The
// page that includes this sets `pages`, all of the site's, relative to itself; it is for a browser
// that lets a file read the others of its folder.
async function checkSite(pages) {
    const here = location.href.replace(/[^/]*$/, "");
    const frame = document.createElement("iframe");
    frame.style = "width: 1200px; height: 800px";
    document.body.append(frame);
    const broken = [], links = new Map(), places = new Map();
    let pictures = 0;
    for (const page of pages) {
        await new Promise(resolve => {
            frame.onload = resolve;
            frame.src = page;
        });
        const content = frame.contentDocument;
        if (!content || content.body.innerText.trim().length < 20) {
            broken.push(`${page}: no text`);
            continue;
        }
        for (const picture of content.images) {
            ++pictures;
            // Those that are not shown are not loaded before they are.
            await picture.decode().catch(() => broken.push(`${page}: picture ${picture.src}`));
        }
        places.set(page, new Set([...content.querySelectorAll("[id], a[name]")].map(e => e.id || e.name)));
        for (const link of content.links) {
            if (link.href.startsWith(here)) {
                links.set(link.href.slice(here.length), page);
            } else if (link.href.startsWith("file:")) {
                broken.push(`${page}: link out of the site, ${link.href}`);
            }
        }
    }
    for (const [link, page] of links) {
        const [target, place] = link.split("#");
        if (!places.has(target)) {
            broken.push(`${page}: link to ${link}`);
        } else if (place && !places.get(target).has(decodeURIComponent(place))) {
            broken.push(`${page}: link to a place that is not there, ${link}`);
        }
    }
    document.body.innerText = broken.join("\n");
    document.title = `checked: ${pages.length} pages, ${pictures} pictures, ${links.size} links, ` +
        `${broken.length} broken`;
}
