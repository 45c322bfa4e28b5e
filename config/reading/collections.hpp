#pragma once
// Codecs of sections and collections: a table in a table, lists, mappings by name, values that may be missing.

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/reading/field_table.hpp"

namespace taktwerk::config {

template <class T>
Codec<T> section(Table<T> table) {
    Codec<T> c;
    c.shape.kind = Shape::Kind::section;
    c.shape.section = table.info();
    c.read = [table = std::make_shared<const Table<T>>(std::move(table))](Reader& reader, const Node& node, T& object) {
        return read_table(reader, node, *table, object);
    };
    return c;
}

template <class M>
Codec<std::vector<M>> list(Codec<M> element) {
    Codec<std::vector<M>> c;
    c.shape.kind = Shape::Kind::list;
    c.shape.element = std::make_shared<const Shape>(element.shape);
    c.read = [element](Reader& reader, const Node& node, std::vector<M>& out) {
        if (node.kind != Node::Kind::list) {
            report_wrong_type(reader, node, "a list", "[a, b]");
            return false;
        }
        out.clear();
        bool good = true;
        for (std::size_t i = 0; i < node.items.size(); ++i) {
            const Reader::Scope scope(reader, std::to_string(i), node.items[i].at);
            M value{};
            good = element.read(reader, node.items[i], value) && good;
            out.push_back(std::move(value));  // also when bad: other parts may name it
        }
        return good;
    };
    if (element.show)
        c.show = [show = element.show](const std::vector<M>& values) {
            std::string text;
            for (const auto& v : values) text += (text.empty() ? "[" : ", ") + show(v);
            return text.empty() ? std::string("[]") : text + "]";
        };
    return c;
}

/// A mapping name -> section; `name(M&)` is where the name goes.
template <class M, class Name>
Codec<std::vector<M>> by_name(Codec<M> element, Name name) {
    Codec<std::vector<M>> c;
    c.shape.kind = Shape::Kind::map;
    c.shape.element = std::make_shared<const Shape>(element.shape);
    c.read = [element, name](Reader& reader, const Node& node, std::vector<M>& out) {
        if (node.kind == Node::Kind::null) return true;
        if (node.kind != Node::Kind::map) {
            report_no_names(reader, node);
            return false;
        }
        bool good = true;
        for (const auto& entry : node.entries) {
            if (report_key_for_name(reader, entry, element.shape)) return false;
            const Reader::Scope scope(reader, entry.key, entry.at);
            M value{};
            name(value) = entry.key;
            good = element.read(reader, entry.value, value) && good;
            out.push_back(std::move(value));  // also when bad: other parts name it
        }
        return good;
    };
    return c;
}

template <class M>
Codec<std::optional<M>> maybe(Codec<M> inner) {
    Codec<std::optional<M>> c;
    c.shape = inner.shape;
    c.read = [inner](Reader& reader, const Node& node, std::optional<M>& out) {
        M value{};
        if (!inner.read(reader, node, value)) return false;
        out = std::move(value);
        return true;
    };
    return c;
}

/// A sub-section whose keys go to the same object.
template <class T>
Field<T> group(std::string key, std::string doc, std::vector<Field<T>> fields, OtherWords instead = {}) {
    Table<T> table{key, doc, std::move(fields), {}, {}, std::move(instead)};
    return field_at<T>(
        key, [](T& object) -> T& { return object; }, section(std::move(table)), std::move(doc));
}

}  // namespace taktwerk::config
