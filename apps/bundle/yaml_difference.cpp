#include "apps/bundle/yaml_difference.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "config/reading/document.hpp"

namespace taktwerk::apps {

namespace {

using config::Node;

constexpr std::size_t longest_value = 60;

std::string joined(const std::string& path, const std::string& key) { return path.empty() ? key : path + "." + key; }

void put_flow(const Node& node, std::string& out) {
    switch (node.kind) {
        case Node::Kind::null: out += "(empty)"; break;
        case Node::Kind::scalar: out += node.text; break;
        case Node::Kind::list:
            out += '[';
            for (std::size_t i = 0; i < node.items.size() && out.size() <= longest_value; ++i) {
                if (i > 0) out += ", ";
                put_flow(node.items[i], out);
            }
            out += ']';
            break;
        case Node::Kind::map:
            out += '{';
            for (std::size_t i = 0; i < node.entries.size() && out.size() <= longest_value; ++i) {
                out += fmt::format("{}{}: ", i > 0 ? ", " : "", node.entries[i].key);
                put_flow(node.entries[i].value, out);
            }
            out += '}';
            break;
    }
}

std::string shown(const Node& node) {
    std::string text;
    put_flow(node, text);
    for (auto& c : text)
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    return text.size() > longest_value ? text.substr(0, longest_value) + "..." : text;
}

const std::string* name_of(const Node& item) {
    const auto* name = item.find("name");
    return name != nullptr && name->kind == Node::Kind::scalar ? &name->text : nullptr;
}

bool all_named(const Node& list) {
    return std::all_of(list.items.begin(), list.items.end(), [](const Node& item) { return name_of(item) != nullptr; });
}

const Node* named(const Node& list, const std::string& name) {
    const auto found = std::find_if(list.items.begin(), list.items.end(), [&](const Node& item) { return *name_of(item) == name; });
    return found == list.items.end() ? nullptr : &*found;
}

class Difference {
public:
    std::vector<std::string> of(const Node& before, const Node& after) {
        compare("", before, after);
        return std::move(lines_);
    }

private:
    void compare(const std::string& path, const Node& before, const Node& after) {
        if (before.kind != after.kind) return changed(path, before, after);
        switch (after.kind) {
            case Node::Kind::null: break;
            case Node::Kind::scalar:
                if (before.text != after.text || before.quoted != after.quoted) changed(path, before, after);
                break;
            case Node::Kind::map:
                for (const auto& entry : after.entries) {
                    const auto key = joined(path, entry.key);
                    if (const auto* old = before.find(entry.key)) compare(key, *old, entry.value);
                    else lines_.push_back(fmt::format("{}: new, {}", key, shown(entry.value)));
                }
                for (const auto& entry : before.entries)
                    if (after.find(entry.key) == nullptr) gone(joined(path, entry.key), entry.value);
                break;
            case Node::Kind::list: compare_lists(path, before, after); break;
        }
    }

    void compare_lists(const std::string& path, const Node& before, const Node& after) {
        if (all_named(before) && all_named(after)) {
            for (const auto& item : after.items) {
                const auto key = fmt::format("{}[{}]", path, *name_of(item));
                if (const auto* old = named(before, *name_of(item))) compare(key, *old, item);
                else lines_.push_back(fmt::format("{}: new, {}", key, shown(item)));
            }
            for (const auto& item : before.items)
                if (named(after, *name_of(item)) == nullptr) gone(fmt::format("{}[{}]", path, *name_of(item)), item);
            order(path, before, after);
            return;
        }
        const auto both = std::min(before.items.size(), after.items.size());
        for (std::size_t i = 0; i < both; ++i) compare(fmt::format("{}[{}]", path, i), before.items[i], after.items[i]);
        for (std::size_t i = both; i < after.items.size(); ++i)
            lines_.push_back(fmt::format("{}[{}]: new, {}", path, i, shown(after.items[i])));
        for (std::size_t i = both; i < before.items.size(); ++i) gone(fmt::format("{}[{}]", path, i), before.items[i]);
    }

    /// The order of slaves is that of the cable.
    void order(const std::string& path, const Node& before, const Node& after) {
        std::vector<std::string> old, now;
        for (const auto& item : before.items)
            if (named(after, *name_of(item)) != nullptr) old.push_back(*name_of(item));
        for (const auto& item : after.items)
            if (named(before, *name_of(item)) != nullptr) now.push_back(*name_of(item));
        if (old != now) lines_.push_back(fmt::format("{}: in another order", path));
    }

    void changed(const std::string& path, const Node& before, const Node& after) {
        lines_.push_back(fmt::format("{}: {} -> {}", path.empty() ? "the file" : path, shown(before), shown(after)));
    }
    void gone(const std::string& path, const Node& node) { lines_.push_back(fmt::format("{}: gone ({})", path, shown(node))); }

    std::vector<std::string> lines_;
};

}  // namespace

std::vector<std::string> yaml_difference(std::string_view before, std::string_view after) {
    const auto old = config::parse_document("before", before), now = config::parse_document("after", after);
    if (!old.errors.empty() || !now.errors.empty())
        return before == after ? std::vector<std::string>{} : std::vector<std::string>{"the text is another one"};
    return Difference().of(old.root, now.root);
}

}  // namespace taktwerk::apps
