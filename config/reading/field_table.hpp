#pragma once
// One table per config struct says everything about its keys: name, member, type, unit, range, documentation. From the table
// come the loader, suggestions for misspelt keys, the JSON Schema and the reference page (config/reference/reference.hpp).
//
//   Table<axes::ManualSpeeds> manual_table() {
//       using M = axes::ManualSpeeds;
//       return {"manual", "speeds for jogging", {
//           field("slow", &M::slow, quantity(Dimension::velocity), "jogging speed; 0 = 5 % of the limit"),
//       }};
//   }

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/reading/document.hpp"
#include "config/reading/quantity.hpp"
#include "config/reading/reader.hpp"

namespace taktwerk::config {

enum class Presence : std::uint8_t { optional, required };

struct SectionInfo;

/// What a value looks like, without its C++ type: for schema and reference.
struct Shape {
    enum class Kind : std::uint8_t { text, integer, number, boolean, quantity, choice, object, fraction, list, pair, map, section, either };
    Kind kind = Kind::text;
    Dimension dimension = Dimension::time;   ///< quantity, pair
    bool none_allowed = false;               ///< quantity: `none` = infinite
    std::optional<double> minimum, maximum;  ///< integer, number
    std::vector<std::string> choices;
    std::shared_ptr<const Shape> element;  ///< list, map
    std::shared_ptr<const SectionInfo> section;
    std::vector<std::shared_ptr<const Shape>> alternatives;  ///< either
};

struct FieldInfo {
    std::string key;
    Presence presence = Presence::optional;
    Shape shape;
    std::string default_text;  ///< empty: nothing to say
    std::string doc;
};

struct SectionInfo {
    std::string title, doc;
    std::vector<FieldInfo> fields;
};

/// How one C++ type is read from a node and shown.
template <class M>
struct Codec {
    Shape shape;
    std::function<bool(Reader&, const Node&, M&)> read;  ///< false: a problem was reported
    std::function<std::string(const M&)> show;
};

template <class T>
struct Field {
    FieldInfo info;
    std::function<bool(Reader&, const Node&, T&)> read;
};

/// Words that people write for keys, and what they are to write instead.
using OtherWords = std::vector<std::pair<std::string, std::string>>;

template <class T>
struct Table {
    std::string title, doc;
    std::vector<Field<T>> fields;
    std::function<void(Reader&, const Node&, T&)> before, after;  ///< rules over several keys
    OtherWords instead{};

    [[nodiscard]] std::shared_ptr<const SectionInfo> info() const {
        auto out = std::make_shared<SectionInfo>(SectionInfo{title, doc, {}});
        for (const auto& f : fields) out->fields.push_back(f.info);
        return out;
    }
};

// --- fields -------------------------------------------------------------------------------------------------------------

/// `get(T&)` gives the member as a reference.
template <class T, class Get, class M>
Field<T> field_at(std::string key, Get get, Codec<M> codec, std::string doc) {
    Field<T> f;
    T defaults{};
    f.info = {std::move(key), Presence::optional, codec.shape, codec.show ? codec.show(get(defaults)) : std::string{}, std::move(doc)};
    f.read = [get, read = std::move(codec.read)](Reader& reader, const Node& node, T& object) { return read(reader, node, get(object)); };
    return f;
}

template <class T, class M>
Field<T> field(std::string key, M T::*member, Codec<M> codec, std::string doc) {
    return field_at<T>(
        std::move(key), [member](T& object) -> M& { return object.*member; }, std::move(codec), std::move(doc));
}

/// A value that goes to several members, or is kept in another form: `set(T&, const M&)`.
template <class T, class M, class Set>
Field<T> field_via(std::string key, Codec<M> codec, Set set, std::string doc, std::string default_text = {}) {
    Field<T> f;
    f.info = {std::move(key), Presence::optional, codec.shape, std::move(default_text), std::move(doc)};
    f.read = [set, read = std::move(codec.read)](Reader& reader, const Node& node, T& object) {
        M value{};
        if (!read(reader, node, value)) return false;
        set(object, value);
        return true;
    };
    return f;
}

template <class T>
Field<T> required(Field<T> f) {
    f.info.presence = Presence::required;
    f.info.default_text.clear();
    return f;
}

template <class T>
Field<T> with_default(Field<T> f, std::string default_text) {
    f.info.default_text = std::move(default_text);
    return f;
}

/// The fields of a member's table as if they stood in T itself.
template <class T, class Get, class M>
void include_fields(std::vector<Field<T>>& into, Get get, const Table<M>& table) {
    for (const auto& inner : table.fields)
        into.push_back({inner.info,
                        [get, read = inner.read](Reader& reader, const Node& node, T& object) { return read(reader, node, get(object)); }});
}

// --- reading ------------------------------------------------------------------------------------------------------------

/// Reports an unknown key with the nearest known one.
void report_unknown_key(Reader& reader, const Entry& entry, const std::vector<std::string>& known, const OtherWords& instead);
/// `{ first: 0,2 m }` is `first: 0` and a key `2 m` without a value: told of the first as what it is. false: `behind` is something else.
bool report_decimal_comma(Reader& reader, const Entry& before, const Entry& behind);
void report_missing_key(Reader& reader, const Node& section, std::string_view key, const FieldInfo& info);
void report_wrong_type(Reader& reader, const Node& node, std::string_view wanted, std::string_view example);
/// Names one of the keys, one that it needs where there is such.
void report_no_section(Reader& reader, const Node& node, const std::vector<const FieldInfo*>& fields);
/// Of what wants a name in front of each of its entries.
void report_no_names(Reader& reader, const Node& node);
/// A key of the element where its name belongs, `workspace: { x: [...] }`. false: it may be a name.
bool report_key_for_name(Reader& reader, const Entry& entry, const Shape& element);
/// What a value of this shape is called in messages, and an example of it.
[[nodiscard]] std::string wanted_text(const Shape& shape, std::string_view axis_unit);

template <class T>
bool read_table(Reader& reader, const Node& node, const Table<T>& table, T& object) {
    if (node.kind != Node::Kind::map) {
        std::vector<const FieldInfo*> fields;
        for (const auto& f : table.fields) fields.push_back(&f.info);
        report_no_section(reader, node, fields);
        return false;
    }
    const auto errors_before = reader.errors().size();
    if (table.before) table.before(reader, node, object);
    std::vector<std::string> known;
    for (const auto& f : table.fields) known.push_back(f.info.key);
    const Reader::Section open(reader, known);
    const Entry* before = nullptr;
    std::vector<const Entry*> told;
    for (const auto& entry : node.entries) {
        bool found = false;
        for (const auto& key : known) found = found || key == entry.key;
        if (!found && before != nullptr && report_decimal_comma(reader, *before, entry)) told.push_back(before);
        else if (!found) report_unknown_key(reader, entry, known, table.instead);
        before = &entry;
    }
    for (const auto& f : table.fields) {
        const Entry* found = nullptr;
        for (const auto& entry : node.entries)
            if (entry.key == f.info.key) found = &entry;
        if (found && std::find(told.begin(), told.end(), found) != told.end()) continue;
        if (found) {
            const Reader::Scope scope(reader, f.info.key, found->at);
            f.read(reader, found->value, object);
        } else if (f.info.presence == Presence::required) {
            report_missing_key(reader, node, f.info.key, f.info);
        }
    }
    if (table.after) table.after(reader, node, object);
    return reader.errors().size() == errors_before;
}

}  // namespace taktwerk::config
