#include "config/machine_file/view_tables.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

using hmi::LocalText;
using hmi::View;
using hmi::ViewName;
using hmi::ViewWidget;
using Kind = ViewWidget::Kind;

constexpr std::size_t longest_text = 400;  ///< bytes
constexpr std::size_t most_views = 32, most_rows = 40, most_in_a_row = 12, most_placed = 60, most_in_a_trend = 8;
constexpr unsigned columns = 12;  ///< of a row

/// Text of people: one line for both languages, or `{en: ..., zh: ...}`.
Codec<LocalText> local_text() {
    using T = LocalText;
    const auto both = section(Table<T>{"text",
                                       "A text in both languages of the page.",
                                       {
                                           required(field("en", &T::english, text(), "in English")),
                                           required(field("zh", &T::chinese, text(), "in Chinese")),
                                       },
                                       {},
                                       {}});
    Codec<T> c;
    c.shape.kind = Shape::Kind::either;
    c.shape.alternatives = {std::make_shared<const Shape>(text().shape), std::make_shared<const Shape>(both.shape)};
    c.read = [both](Reader& reader, const Node& node, T& out) {
        if (node.kind == Node::Kind::map) {
            if (!both.read(reader, node, out)) return false;
        } else {
            if (!text().read(reader, node, out.english)) return false;
            out.chinese = out.english;
        }
        if (out.english.size() <= longest_text && out.chinese.size() <= longest_text) return true;
        reader.problem(node.at, "view.too_much", fmt::format("`{}` has more than {} bytes", reader.path(), longest_text), "shorten it");
        return false;
    };
    return c;
}

bool read_value_name(Reader& reader, const Node& node, ViewName& out) {
    if (!text().read(reader, node, out.text)) return false;
    out.where = located(reader.file(), node.at);
    return true;
}

/// One value.
Codec<std::vector<ViewName>> value_name() {
    Codec<std::vector<ViewName>> c;
    c.shape = text().shape;
    c.read = [](Reader& reader, const Node& node, std::vector<ViewName>& out) { return read_value_name(reader, node, out.emplace_back()); };
    return c;
}

/// One value, or a list.
Codec<std::vector<ViewName>> value_names() {
    Codec<std::vector<ViewName>> c;
    c.shape.kind = Shape::Kind::either;
    Shape several;
    several.kind = Shape::Kind::list;
    several.element = std::make_shared<const Shape>(text().shape);
    c.shape.alternatives = {std::make_shared<const Shape>(text().shape), std::make_shared<const Shape>(several)};
    c.read = [](Reader& reader, const Node& node, std::vector<ViewName>& out) {
        if (node.kind != Node::Kind::list) return read_value_name(reader, node, out.emplace_back());
        if (node.items.empty() || node.items.size() > most_in_a_trend) {
            reader.problem(node.at, "view.too_much",
                           fmt::format("a trend shows 1 to {} values, and this has {}", most_in_a_trend, node.items.size()),
                           node.items.empty() ? "name a value" : "make two trends of it");
            return false;
        }
        bool good = true;
        for (const auto& item : node.items) good = read_value_name(reader, item, out.emplace_back()) && good;
        return good;
    };
    return c;
}

/// A key that makes a widget of that kind.
Field<ViewWidget> kind_field(const char* key, Kind kind, Codec<std::vector<ViewName>> codec, const char* doc) {
    return field_via<ViewWidget>(
        key, std::move(codec),
        [kind](ViewWidget& widget, const std::vector<ViewName>& names) {
            widget.kind = kind;
            widget.names = names;
        },
        doc);
}

struct KindKey {
    std::string_view key;
    Kind kind;
};
constexpr std::array<KindKey, 11> kinds{{{"value", Kind::value},
                                         {"lamp", Kind::lamp},
                                         {"button", Kind::button},
                                         {"switch", Kind::toggle},
                                         {"set", Kind::set},
                                         {"bar", Kind::bar},
                                         {"trend", Kind::trend},
                                         {"axis", Kind::axis},
                                         {"text", Kind::text},
                                         {"alarms", Kind::alarms},
                                         {"image", Kind::image}}};

bool is_one_of(Kind kind, std::initializer_list<Kind> all) {
    for (const auto one : all)
        if (one == kind) return true;
    return false;
}

/// Which keys of the others mean something for this kind.
bool means(std::string_view key, Kind kind) {
    if (key == "minimum" || key == "maximum") return is_one_of(kind, {Kind::bar, Kind::trend});
    if (key == "decimals") return is_one_of(kind, {Kind::value, Kind::set, Kind::bar, Kind::trend});
    if (key == "tone") return kind == Kind::lamp;
    if (key == "seconds") return kind == Kind::trend;
    if (key == "placed") return kind == Kind::image;
    if (key == "label") return kind != Kind::text;
    return true;
}

/// In the machine file's folder, or below it.
bool lies_inside(const std::string& image) {
    const auto file = std::filesystem::path(image).lexically_normal();
    return !file.empty() && !file.is_absolute() && *file.begin() != "..";
}

/// Whoever hands the machine on hands on its folder: a picture from elsewhere would be missing there, or be another one.
void check_image(Reader& reader, const Node& node, ViewWidget& widget) {
    widget.where = located(reader.file(), node.at);
    if (lies_inside(widget.image)) return;
    reader.problem(node.at, "view.image_outside", fmt::format("picture '{}' does not lie in the machine file's folder", widget.image),
                   "put it beside the machine file, or into a folder beside it");
}

/// Exactly one key says what it is; the others suit it.
void check_widget(Reader& reader, const Node& node, ViewWidget& widget) {
    widget.where = located(reader.file(), node.at);
    const Entry* said = nullptr;
    for (const auto& entry : node.entries) {
        for (const auto& [key, kind] : kinds) {
            if (entry.key != key) continue;
            if (said != nullptr)
                return reader.problem(entry.at, "view.several_kinds",
                                      fmt::format("`{}` is a {} already, and not a {} as well", reader.path(), said->key, key),
                                      "write two widgets");
            said = &entry;
            widget.kind = kind;
        }
    }
    if (said == nullptr)
        return reader.problem(node.at, "view.no_kind", fmt::format("`{}` does not say what it is", reader.path()),
                              "write one of value, lamp, button, switch, set, bar, trend, axis, text, alarms and image");
    if (widget.kind == Kind::image) check_image(reader, said->value, widget);
    if (widget.kind == Kind::alarms && said->value.text == "false")
        reader.problem(said->value.at, "view.no_meaning", fmt::format("`{}` would show nothing", reader.path()),
                       "write `alarms: true`, or remove the widget");
    for (const auto& entry : node.entries)
        if (!means(entry.key, widget.kind))
            reader.problem(entry.at, "view.no_meaning", fmt::format("a {} has no `{}`", said->key, entry.key),
                           fmt::format("remove `{}`", entry.key));
    if (widget.minimum && widget.maximum && !(*widget.minimum < *widget.maximum))
        reader.problem(node.find("maximum")->at, "view.range",
                       fmt::format("`{}` would go from {:g} to {:g}", reader.path(), *widget.minimum, *widget.maximum),
                       "give a `minimum` below the `maximum`");
}

std::vector<Field<ViewWidget>> common_fields() {
    using W = ViewWidget;
    using Tone = W::Tone;
    return {
        kind_field("value", Kind::value, value_name(), "shows this value"),
        kind_field("lamp", Kind::lamp, value_name(), "a lamp: lit while this is not 0"),
        with_default(field("label", &W::label, local_text(), "beside it"), "the value's name"),
        with_default(field("decimals", &W::decimals, maybe(integer<std::uint8_t>(0, 9)), "behind the point"), "as many as it needs"),
        field("tone", &W::tone, choice<Tone>({{"good", Tone::good}, {"warn", Tone::warn}, {"bad", Tone::bad}}), "of a lamp that is lit"),
    };
}

Table<ViewWidget> placed_table() {
    using W = ViewWidget;
    Table<W> table{"views.<name>.rows.placed", "A value or a lamp on a picture.", common_fields(), {}, check_widget};
    table.fields.push_back(required(field("x", &W::x, number(0, 100), "percent of the picture's width, from the left: its middle")));
    table.fields.push_back(required(field("y", &W::y, number(0, 100), "percent of its height, from the top")));
    return table;
}

Codec<std::vector<ViewWidget>> bounded(Codec<std::vector<ViewWidget>> widgets, std::size_t most, const char* what) {
    widgets.read = [read = std::move(widgets.read), most, what](Reader& reader, const Node& node, std::vector<ViewWidget>& out) {
        if (node.items.size() > most) {
            reader.problem(node.at, "view.too_much", fmt::format("{} {}, at most {} are shown", node.items.size(), what, most),
                           "make two of it");
            return false;
        }
        return read(reader, node, out);
    };
    return widgets;
}

Table<ViewWidget> widget_table() {
    using W = ViewWidget;
    Table<W> table{"views.<name>.rows",
                   "A widget; exactly one key says what it is. Values go by name: `program.variable`, `program.parameter`, "
                   "`axis.actual_position`, `in.point`, `out.point`, `machine.mode`.",
                   common_fields(),
                   {},
                   check_widget};
    auto& f = table.fields;
    f.push_back(kind_field("button", Kind::button, value_name(), "pressed and held: a variable declared by d.operator_button"));
    f.push_back(kind_field("switch", Kind::toggle, value_name(), "on and off: a variable declared by d.operator_switch"));
    f.push_back(kind_field("set", Kind::set, value_name(), "a number to write: a variable declared by d.operator_value, or a parameter"));
    f.push_back(kind_field("bar", Kind::bar, value_name(), "this value between two ends"));
    f.push_back(kind_field("trend", Kind::trend, value_names(), "these values over the last seconds; of one unit best"));
    f.push_back(kind_field("axis", Kind::axis, value_name(), "an axis: state, position between its limits, velocity"));
    f.push_back(field_via<W>(
        "text", local_text(), [](W& w, const LocalText& t) { w.kind = Kind::text, w.label = t; }, "only a text"));
    f.push_back(field_via<W>(
        "alarms", boolean(), [](W& w, const bool&) { w.kind = Kind::alarms; }, "`true`: what alarms stand, with reset"));
    f.push_back(field_via<W>(
        "image", text(), [](W& w, const std::string& file) { w.kind = Kind::image, w.image = file; },
        "a picture: a PNG, JPEG or SVG file of at most 1 MiB, in the folder of this file or below it"));
    f.push_back(with_default(field("placed", &W::placed, bounded(list(section(placed_table())), most_placed, "values on one picture"),
                                   "values and lamps on the picture"),
                             ""));
    f.push_back(with_default(field("minimum", &W::minimum, maybe(number()), "of a bar or trend: its lower end"), "the value's own"));
    f.push_back(with_default(field("maximum", &W::maximum, maybe(number()), "its upper end"), "the value's own"));
    f.push_back(field("seconds", &W::seconds, integer<std::uint16_t>(1, 600), "that a trend shows"));
    f.push_back(with_default(field("width", &W::width, integer<std::uint8_t>(1, columns), "of the twelve columns of a row"),
                             "what the others leave"));
    return table;
}

using Row = std::vector<ViewWidget>;

/// Something stands in it, and all of it fits: what says no `width` has one column at least.
Codec<Row> row() {
    auto widgets = bounded(list(section(widget_table())), most_in_a_row, "widgets in one row");
    widgets.read = [read = std::move(widgets.read)](Reader& reader, const Node& node, Row& out) {
        if (!read(reader, node, out)) return false;
        if (out.empty()) {
            reader.problem(node.at, "view.empty_row", fmt::format("`{}` has no widget", reader.path()), "add one, or remove the row");
            return false;
        }
        unsigned taken = 0;
        for (const auto& widget : out) taken += std::max<unsigned>(widget.width, 1);
        if (taken <= columns) return true;
        reader.problem(node.at, "view.too_wide",
                       fmt::format("the widgets of `{}` need {} columns, and a row has {}", reader.path(), taken, columns),
                       "give them less `width` (without one a widget needs one column at least), or make two rows of it");
        return false;
    };
    return widgets;
}

Table<View> view_table() {
    using V = View;
    auto rows = list(row());
    rows.read = [read = std::move(rows.read)](Reader& reader, const Node& node, std::vector<Row>& out) {
        if (node.kind == Node::Kind::list && (node.items.empty() || node.items.size() > most_rows)) {
            reader.problem(node.at, "view.too_much", fmt::format("a view has 1 to {} rows, and this has {}", most_rows, node.items.size()),
                           node.items.empty() ? "add a row, or remove the view" : "make several views of it");
            return false;
        }
        return read(reader, node, out);
    };
    return {"views.<name>",
            "A page of the machine builder's own: rows of widgets.",
            {
                required(field("title", &V::title, local_text(), "in the page's navigation; short")),
                required(field("rows", &V::rows, std::move(rows), "each a list of widgets, from left to right")),
            },
            {},
            [](Reader& reader, const Node& node, V& view) { view.where = located(reader.file(), node.at); }};
}

}  // namespace

Field<MachineFile> views_field() {
    using F = MachineFile;
    auto views = by_name(section(view_table()), [](View& v) -> std::string& { return v.name; });
    views.read = [read = std::move(views.read)](Reader& reader, const Node& node, std::vector<View>& out) {
        if (node.entries.size() > most_views) {
            reader.problem(node.at, "view.too_much", fmt::format("{} views, at most {} are shown", node.entries.size(), most_views),
                           "leave some out");
            return false;
        }
        const bool good = read(reader, node, out);
        const auto folder = std::filesystem::path(reader.file()).parent_path();
        for (auto& view : out)
            for (auto& row : view.rows)
                for (auto& widget : row)
                    if (widget.kind == Kind::image && lies_inside(widget.image))
                        widget.image_path = (folder / widget.image).lexically_normal().string();
        return good;
    };
    return with_default(field_at<F>(
                            "views", [](F & m) -> auto& { return m.hmi.views; }, std::move(views),
                            "pages of the machine builder's own (docs/views.md); the first is the page an operator begins with"),
                        "none");
}

}  // namespace taktwerk::config
