// report.html of pictures that differ: one file that holds all it shows.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <span>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"
#include "engine/io/file.hpp"
#include "viewer/compare/output_files.hpp"
#include "viewer/compare/picture_comparison.hpp"
#include "viewer/image/png.hpp"
#include "viewer/report/html.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kMostOfPicture = std::uint64_t{1} << 28;
constexpr std::size_t kMostEmbedded = std::size_t{24} << 20;  // bytes of pictures in one page
constexpr std::size_t kAtOnce = 16;                           // pictures that are drawn before they are written

constexpr const char* kStyle =
    R"(body{font:14px/1.45 sans-serif;margin:1em 1.2em;color:#222;background:#fff}h1{font-size:20px;margin:0 0 .3em}
.cols{display:flex;gap:1em;align-items:flex-start;flex-wrap:wrap}.list{max-height:82vh;overflow:auto;border:1px solid #ddd}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}td,th{padding:3px 7px;text-align:left;white-space:nowrap;border-bottom:1px solid #eee}
th{background:#f4f4f4;position:sticky;top:0}td.n{text-align:right}tbody tr{cursor:pointer}tbody tr.on{background:#dcebf7}tbody tr:hover{background:#f0f6fb}
.stage{position:relative;overflow:hidden;background:#181a1e;user-select:none;cursor:ew-resize}.stage img{position:absolute;left:0;top:0;image-rendering:pixelated}
.cut{position:absolute;top:0;bottom:0;width:2px;background:#ffd23c;margin-left:-1px}.box{position:absolute;border:2px solid #50dcff;box-sizing:content-box;margin:-2px}
.tag{position:absolute;bottom:6px;padding:1px 8px;background:#000a;color:#fff;font-weight:bold;border-radius:3px}.view{flex:1 1 640px;min-width:0}
.bar{margin:.4em 0;display:flex;gap:.7em;align-items:center;flex-wrap:wrap}.bar input[type=range]{width:150px}#say{margin:.5em 0;padding-left:1.2em}
.pan{max-width:100%;overflow:auto;border:1px solid #ddd})";

// a click on a row shows it; the slider, or the pointer over the picture, wipes from A to B
constexpr const char* kScript =
    R"(const $=i=>document.getElementById(i),rows=[...document.querySelectorAll('#frames tbody tr')];let now=0,mode='wipe';
function wipe(v){$('a').style.clipPath='inset(0 '+(100-v)+'% 0 0)';$('cut').style.left=v+'%';$('ta').style.right='calc('+(100-v)+'% + 6px)';$('tb').style.left='calc('+v+'% + 6px)';}
function fit(w){const room=$('view').clientWidth-4,all=[...$('zoom').options].map(o=>Number(o.value)).filter(z=>z*w<=room);return all.length?Math.max(...all):Number($('zoom').options[0].value);}
let fitted=false;
function show(i){const other=i!==now||!fitted;now=Math.max(0,Math.min(rows.length-1,i));const d=data[now];if(d.a&&!fitted){$('zoom').value=fit(d.w);fitted=true;}const z=Number($('zoom').value);if(other&&d.box&&mode==='wipe')$('wipe').value=100*(d.box[0]+d.box[2]/2)/d.w;rows.forEach((r,k)=>r.classList.toggle('on',k===now));
rows[now].scrollIntoView({block:'nearest'});$('name').textContent=d.name;$('say').replaceChildren(...d.say.map(t=>{const l=document.createElement('li');l.textContent=t;return l;}));
const st=$('stage');st.hidden=!d.a;$('none').hidden=!!d.a;if(!d.a){$('none').textContent=d.none;return;}
for(const k of['a','b','d']){const m=$(k);m.src=d[k]||'';m.style.width=d.w*z+'px';m.style.height=d.h*z+'px';m.style.imageRendering=z<1?'auto':'pixelated';}st.style.width=d.w*z+'px';st.style.height=d.h*z+'px';
$('d').hidden=mode!=='diff';$('cut').hidden=$('ta').hidden=$('tb').hidden=mode!=='wipe';const b=$('box');b.hidden=!d.box||!$('frame').checked;
if(d.box){b.style.left=d.box[0]*z+'px';b.style.top=d.box[1]*z+'px';b.style.width=d.box[2]*z+'px';b.style.height=d.box[2]*z+'px';}wipe(mode==='b'?0:mode==='a'?100:$('wipe').value);}
rows.forEach((r,i)=>r.addEventListener('click',()=>show(i)));$('wipe').addEventListener('input',()=>{set('wipe');});
function set(m){mode=m;document.querySelectorAll('[name=mode]').forEach(e=>e.checked=e.value===m);show(now);}
document.querySelectorAll('[name=mode]').forEach(e=>e.addEventListener('change',()=>set(e.value)));$('zoom').addEventListener('change',()=>show(now));$('frame').addEventListener('change',()=>show(now));
$('stage').addEventListener('pointermove',e=>{if(e.buttons&1&&mode==='wipe'){const r=$('stage').getBoundingClientRect();$('wipe').value=100*(e.clientX-r.left)/r.width;wipe($('wipe').value);}});
document.addEventListener('keydown',e=>{if(e.target.tagName==='INPUT'&&e.target.type==='range')return;if(e.key==='ArrowDown'){show(now+1);e.preventDefault();}if(e.key==='ArrowUp'){show(now-1);e.preventDefault();}});
if(rows.length)show(0);)";

std::string json(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += '\\', out += c;
    else if (c == '<')
      out += "\\u003c";  // no tag can end the script
    else if (static_cast<unsigned char>(c) < ' ')
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      out += c;
  }
  return out + "\"";
}

/// How far apart, for the order: what isn't there or doesn't fit first.
double rank(const PictureComparison& c) {
  return c.verdict == PictureComparison::different ? static_cast<double>(c.difference.differing) : 1e18;
}

const char* verdict_text(const PictureComparison& c) {
  switch (c.verdict) {
    case PictureComparison::same:
      return "same";
    case PictureComparison::different:
      return "different";
    case PictureComparison::sizes:
      return "other size";
    case PictureComparison::missing_in_a:
      return "only in B";
    case PictureComparison::missing_in_b:
      return "only in A";
  }
  return "";
}

std::string cause_word(const PictureComparison& c) {
  if (c.verdict != PictureComparison::different) return "";
  switch (c.cause) {
    case ChangeCause::unknown:
      return "";
    case ChangeCause::other_scene:
      return "other scene";
    case ChangeCause::other_frame:
      return "other frame";
    case ChangeCause::state:
      return "state";
    case ChangeCause::drawing:
      return "drawing";
    case ChangeCause::view:
      return "view";
    case ChangeCause::renderer:
      return "renderer";
  }
  return "";
}

std::string row(const PictureComparison& c) {
  std::string out = fmt::format("<tr><td>{}</td><td>{}</td>", html_text(c.name), verdict_text(c));
  if (c.verdict != PictureComparison::different) return out + "<td></td><td></td><td></td><td></td><td></td></tr>\n";
  const Difference& d = c.difference;
  return out + fmt::format(
                   "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
                   "class=\"n\">{:.4f}</td><td>{}</td></tr>\n",
                   d.differing, d.worst_window, d.max_level, c.flip, cause_word(c));
}

/// What is drawn of a pair that differs, as PNG: which pixels do, and the three panels.
struct Drawn {
  int width = 0, height = 0;
  std::string overlay, panels;
};

Drawn drawn_of(const PictureComparison& c, const PictureRules& rules) {
  if (c.verdict != PictureComparison::different) return {};
  const Image a = read_png(c.a), b = read_png(c.b);
  return {a.width, a.height,
          encode_png(difference_overlay(a, b, c.difference.settings.tolerance, a.width >= 600 ? 2 : 0, rules.mask)),
          encode_png(difference_panels(a, b, c.difference, rules.mask))};
}

std::string data(const PictureComparison& c, const Drawn& drawn, std::size_t& embedded) {
  std::vector<std::string> say;
  say.push_back(json(c.headline));
  for (const std::string& line : c.details) say.push_back(json(line));
  std::string out = fmt::format("{{name:{},say:[{}]", json(c.name), fmt::join(say, ","));
  if (c.verdict != PictureComparison::different) return out + fmt::format(",none:{}}}", json(c.headline));
  if (embedded > kMostEmbedded)
    return out + fmt::format(",none:{}}}", json("too many pictures for one page: this one lies beside it, " + c.name));
  const std::string a = read_file(c.a, kMostOfPicture), b = read_file(c.b, kMostOfPicture);
  embedded += a.size() + b.size() + drawn.overlay.size();
  out += fmt::format(",w:{},h:{},a:\"{}\",b:\"{}\",d:\"{}\"", drawn.width, drawn.height, png_data_uri(a),
                     png_data_uri(b), png_data_uri(drawn.overlay));
  const Difference& diff = c.difference;
  return out + fmt::format(",box:[{},{},{}]}}", diff.worst_at[0], diff.worst_at[1], diff.settings.window);
}

// "3", or "3 or 10" where the pictures have limits of their own
std::string tolerances(const std::vector<const PictureComparison*>& pictures, const PictureRules& rules) {
  std::set<int> values;
  for (const PictureComparison* c : pictures)
    if (c->verdict == PictureComparison::different) values.insert(c->difference.settings.tolerance);
  if (values.empty()) values.insert(rules.settings.tolerance);
  return fmt::format("{}", fmt::join(values, " or "));
}

}  // namespace

void write_picture_report(const fs::path& out, const std::string& title, const std::vector<PictureComparison>& pictures,
                          const PictureRules& rules, const std::vector<std::string>& failures) {
  OutputFiles files;
  files.make_folder(out);
  std::vector<const PictureComparison*> order;
  for (const PictureComparison& c : pictures)
    if (c.verdict != PictureComparison::same) order.push_back(&c);
  std::stable_sort(order.begin(), order.end(),
                   [](const PictureComparison* l, const PictureComparison* r) { return rank(*l) > rank(*r); });

  std::string rows, entries;
  std::size_t embedded = 0;
  for (std::size_t begin = 0; begin < order.size(); begin += kAtOnce) {
    const std::span<const PictureComparison* const> some =
        std::span(order).subspan(begin, std::min(kAtOnce, order.size() - begin));
    std::vector<Drawn> drawn(some.size());
    parallel_for(some.size(), 1, [&](std::size_t i) { drawn[i] = drawn_of(*some[i], rules); });
    for (std::size_t i = 0; i < some.size(); ++i) {
      const PictureComparison& c = *some[i];
      rows += row(c);
      entries += data(c, drawn[i], embedded) + ",\n";
      if (c.verdict != PictureComparison::different) continue;
      const fs::path panels = out / c.name;
      files.make_folder(panels.parent_path());
      files.write(panels, drawn[i].panels);
    }
  }
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta "
      "charset=\"utf-8\"><title>{0}</title><style>{1}</style></head><body>\n<h1>{0}</h1>\n",
      html_text(title), kStyle);
  if (!failures.empty()) {
    page += "<ul id=\"failures\">\n";
    for (const std::string& line : failures) page += "<li>" + html_text(line) + "</li>\n";
    page += "</ul>\n";
  }
  if (order.empty()) {
    files.write(out / "report.html", page + "</body></html>\n");
    return files.keep();
  }
  const auto missing = static_cast<std::size_t>(std::count_if(order.begin(), order.end(), [](const auto* c) {
    return c->verdict == PictureComparison::missing_in_a || c->verdict == PictureComparison::missing_in_b;
  }));
  page += fmt::format(
      "<p>{} of {} pictures differ{}. A pixel counts once a channel differs by more than {} of 255; the limits are "
      "{:g} "
      "a megapixel, {:g} % of what is drawn, and {} in any {} x {} window. "
      "Arrow keys change the row; drag over the picture, or the slider, to wipe from A to B.</p>\n",
      order.size() - missing, pictures.size() - missing,
      missing == 0 ? "" : fmt::format(", {} more {} in one of them only", missing, missing == 1 ? "is" : "are"),
      tolerances(order, rules), rules.settings.allowed_per_megapixel, 100 * rules.settings.allowed_of_drawn,
      rules.settings.allowed_in_window, rules.settings.window, rules.settings.window);
  page +=
      "<div class=\"cols\"><div class=\"list\"><table "
      "id=\"frames\"><thead><tr><th>picture</th><th></th><th>pixels</th><th>in a "
      "window</th><th>levels</th><th>FLIP</th><th>changed</th></tr></thead><tbody>\n" +
      rows + "</tbody></table></div>\n";
  page +=
      "<div class=\"view\" id=\"view\"><b id=\"name\"></b><div class=\"bar\"><span>A <input type=\"range\" id=\"wipe\" "
      "min=\"0\" max=\"100\" step=\"0.1\" value=\"50\"> B</span>";
  for (const auto& [value, text] : {std::pair{"wipe", "wipe"}, {"a", "A"}, {"b", "B"}, {"diff", "difference"}})
    page += fmt::format("<label><input type=\"radio\" name=\"mode\" value=\"{}\"{}> {}</label>", value,
                        std::string(value) == "wipe" ? " checked" : "", text);
  page += "<label>zoom <select id=\"zoom\">";
  for (const char* z : {"0.25", "0.5", "0.7", "1", "2", "3", "4", "8"}) page += fmt::format("<option>{}</option>", z);
  page += "</select></label><label><input type=\"checkbox\" id=\"frame\" checked> worst window</label></div>\n";
  page +=
      "<div class=\"pan\"><div class=\"stage\" id=\"stage\" hidden><img id=\"b\" alt=\"B\" draggable=\"false\"><img "
      "id=\"a\" alt=\"A\" draggable=\"false\"><img id=\"d\" alt=\"difference\" draggable=\"false\" hidden>"
      "<div class=\"cut\" id=\"cut\"></div><div class=\"box\" id=\"box\"></div><span class=\"tag\" "
      "id=\"ta\">A</span><span class=\"tag\" id=\"tb\">B</span></div></div><p id=\"none\" hidden></p><ul "
      "id=\"say\"></ul></div></div>\n";
  page += "<script>const data=[" + entries + "];\n" + kScript + "</script>\n</body></html>\n";
  files.write(out / "report.html", page);
  files.keep();
}

}  // namespace impinge
