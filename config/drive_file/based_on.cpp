#include "config/drive_file/based_on.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>

#include "config/reading/file_library.hpp"

namespace taktwerk::config {

namespace {

constexpr std::string_view base_key = "based_on";
constexpr std::array<std::string_view, 4> merged_sections{"motion", "mailbox", "dc", "behaviour"};

void stand_at(Node& node, Position at) {
    node.at = at;
    for (auto& item : node.items) stand_at(item, at);
    for (auto& entry : node.entries) {
        entry.at = at;
        stand_at(entry.value, at);
    }
}

Entry* find_entry(Node& node, std::string_view key) {
    const auto it = std::ranges::find(node.entries, key, &Entry::key);
    return it == node.entries.end() ? nullptr : &*it;
}

std::string object_of(const Node& row) {
    const auto* object = row.find("object");
    std::string text = object != nullptr ? object->text : std::string{};
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text;
}

/// Rows of the base that `own` does not have.
void add_rows(Node& own, const Node& base) {
    const auto count = static_cast<std::ptrdiff_t>(own.items.size());
    for (const auto& row : base.items) {
        const auto same = [&](const Node& other) { return object_of(other) == object_of(row); };
        if (std::none_of(own.items.begin(), own.items.begin() + count, same)) own.items.push_back(row);
    }
}

/// Those of the base that nobody states now, then the file's own.
Node assumptions(const Node& own, const Node* base) {
    Node out;
    out.kind = Node::Kind::list;
    if (base != nullptr)
        for (const auto& row : base->items) {
            const auto* unless = row.find("unless");
            const bool stated = unless != nullptr &&
                                std::ranges::any_of(unless->items, [&](const Node& key) { return find_path(own, key.text) != nullptr; });
            if (!stated) out.items.push_back(row);
        }
    if (const auto* rows = own.find("assumptions")) out.items.insert(out.items.end(), rows->items.begin(), rows->items.end());
    return out;
}

}  // namespace

const Node* find_path(const Node& node, std::string_view path) noexcept {
    const auto dot = path.find('.');
    const auto* next = node.find(path.substr(0, dot));
    return next == nullptr || dot == std::string_view::npos ? next : find_path(*next, path.substr(dot + 1));
}

Node merged_drive(const Node& own, const Node& base) {
    Node out = own;
    const auto* key = own.find(base_key);
    Node from = base;
    stand_at(from, key != nullptr ? key->at : Position{});
    std::erase_if(out.entries, [](const Entry& entry) { return entry.key == base_key || entry.key == "assumptions"; });
    for (const auto& entry : from.entries) {
        if (entry.key == "assumptions") continue;
        auto* there = find_entry(out, entry.key);
        if (there == nullptr) {
            out.entries.push_back(entry);
        } else if (entry.key == "objects") {
            add_rows(there->value, entry.value);
        } else if (std::ranges::find(merged_sections, entry.key) != merged_sections.end() && there->value.kind == Node::Kind::map) {
            for (const auto& inner : entry.value.entries)
                if (find_entry(there->value, inner.key) == nullptr) there->value.entries.push_back(inner);
        }
    }
    auto left = assumptions(own, from.find("assumptions"));
    if (!left.items.empty()) out.entries.push_back({"assumptions", from.at, std::move(left)});
    return out;
}

Document read_drive_document(const std::string& path, const std::vector<std::string>& folders) {
    auto document = read_document(path);
    const auto* base = document.root.find(base_key);
    if (base == nullptr) return document;
    auto places = folders;
    places.insert(places.begin(), std::filesystem::path(path).parent_path().string());
    const auto file = find_file(places, base->text);
    const auto problem = [&](std::string what, std::string remedy) {
        document.errors.push_back({"config.based_on", located(path, base->at), std::move(what), std::move(remedy)});
        return document;
    };
    if (file.empty())
        return problem(fmt::format("there is no drive file '{}' to base it on", base->text), "correct the name: `based_on: cia402`");
    auto found = read_document(file);
    document.based_on = file;
    document.errors.insert(document.errors.end(), found.errors.begin(), found.errors.end());
    if (found.root.find(base_key) != nullptr)
        return problem(fmt::format("'{}' is based on another file itself", base->text), "name the file that all of them are based on");
    if (found.errors.empty()) document.root = merged_drive(document.root, found.root);
    return document;
}

}  // namespace taktwerk::config
