#include "ecat/esi/element.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/one_line.hpp"
#include "ecat/esi/esi_number.hpp"

namespace taktwerk::ecat::esi {

namespace {

constexpr std::size_t most_findings = 200;  // of a file that is no ESI at all, the rest says nothing new
constexpr int english = 1033, chinese = 2052;

/// Pictures and lay-out: nothing of the slave, and never worth a word.
bool is_decoration(std::string_view name) {
    return name.rfind("Image", 0) == 0 || name.rfind("xsi:", 0) == 0 || name.rfind("xmlns", 0) == 0;
}

void count(Findings& findings, const std::string& path, const SourceText& source, pugi::xml_node node) {
    auto& unread = findings.unread[path];
    if (unread.count++ == 0) unread.path = path, unread.line = source.line(node);
}

int language(pugi::xml_node node) {
    const auto number = parse_number(node.attribute("LcId").value());
    return number ? static_cast<int>(*number & 0xFFFF) : 0;
}

/// Devices are called by their type, all others counted where there are several.
std::string step(pugi::xml_node node) {
    const std::string name = node.name();
    if (name == "Device" || name == "Module") {
        const auto type = on_one_line(trimmed(node.child("Type").child_value()));
        if (!type.empty()) return fmt::format("{} '{}'", name, type);
    }
    std::size_t before = 0;
    for (auto other = node.previous_sibling(name.c_str()); other; other = other.previous_sibling(name.c_str())) ++before;
    const bool several = before > 0 || node.next_sibling(name.c_str());
    return several ? fmt::format("{}[{}]", name, before + 1) : name;
}

}  // namespace

void SourceText::find_lines(std::string_view utf8) {
    for (auto at = utf8.find('\n'); at != std::string_view::npos; at = utf8.find('\n', at + 1)) line_ends.push_back(at);
}

std::size_t SourceText::line(pugi::xml_node node) const {
    const auto offset = node.offset_debug();
    if (offset < 0) return 0;
    const auto before = std::lower_bound(line_ends.begin(), line_ends.end(), static_cast<std::size_t>(offset));
    return static_cast<std::size_t>(before - line_ends.begin()) + 1;
}

std::string SourceText::place(std::ptrdiff_t offset) const {
    if (offset < 0) return file;
    const auto at = static_cast<std::size_t>(offset);
    const auto before = std::lower_bound(line_ends.begin(), line_ends.end(), at);
    const std::size_t start = before == line_ends.begin() ? 0 : *(before - 1) + 1;
    return fmt::format("{}:{}:{}", file, before - line_ends.begin() + 1, at - start + 1);
}

void Element::knows(std::initializer_list<std::string_view> children, std::initializer_list<std::string_view> attributes) const {
    const auto listed = [](auto list, std::string_view name) { return std::find(list.begin(), list.end(), name) != list.end(); };
    // One path for all of a kind: "Device/TxPdo/Entry/Comment".
    const auto here = [&] {
        std::string path;
        for (auto node = node_;
             node && std::string_view(node.name()) != "Devices" && std::string_view(node.name()) != "Modules" && node.parent();
             node = node.parent())
            path = path.empty() ? node.name() : std::string(node.name()) + "/" + path;
        return path;
    };
    for (const auto& child : node_.children())
        if (child.type() == pugi::node_element && !listed(children, child.name()) && !is_decoration(child.name()))
            count(*findings_, here() + "/" + child.name(), *source_, child);
    for (const auto& attribute : node_.attributes())
        if (!listed(attributes, attribute.name()) && !is_decoration(attribute.name()))
            count(*findings_, here() + "@" + attribute.name(), *source_, node_);
}

std::vector<Element> Element::children(const char* name) const {
    std::vector<Element> out;
    for (auto child = node_.child(name); child; child = child.next_sibling(name)) out.emplace_back(child, *source_, *findings_, grave_);
    return out;
}

std::string Element::text() const {
    std::string out;
    for (const auto& part : node_.children())
        if (part.type() == pugi::node_pcdata || part.type() == pugi::node_cdata) out += part.value();
    return std::string{trimmed(on_one_line(out))};
}

std::string Element::attribute(const char* name) const { return on_one_line(node_.attribute(name).value()); }

std::string Element::in_english(const char* name) const {
    const auto all = children(name);
    const auto rank = [](const Element& one) {
        const int lcid = language(one.node());
        if (lcid == english) return 0;
        if (lcid != 0 && (lcid & 0x3FF) == (english & 0x3FF)) return 1;
        if (lcid == 0) return 2;
        return lcid == chinese ? 3 : 4;
    };
    const auto best = std::min_element(all.begin(), all.end(), [&](const Element& a, const Element& b) { return rank(a) < rank(b); });
    return best == all.end() ? std::string{} : best->text();
}

std::string Element::in_chinese(const char* name) const {
    for (const auto& one : children(name))
        if (language(one.node()) == chinese) return one.text();
    return {};
}

std::optional<std::int64_t> Element::checked(std::string_view text, const std::string& what, std::int64_t low, std::int64_t high) const {
    const auto value = parse_number(text);
    if (!value) {
        const auto shown = on_one_line(text.substr(0, 40));
        problem("esi.number", fmt::format("{} is '{}', which is no number", what, shown), "write a number such as 16 or #x10");
        return std::nullopt;
    }
    if (*value < low || *value > high) {
        problem("esi.number", fmt::format("{} is {}, beyond {} to {}", what, on_one_line(trimmed(text)), low, high),
                "correct it, or ask the vendor for a newer file");
        return std::nullopt;
    }
    return value;
}

std::optional<std::int64_t> Element::number_in(const char* name, std::int64_t low, std::int64_t high) const {
    const auto found = node_.attribute(name);
    if (!found || trimmed(found.value()).empty()) return std::nullopt;
    return checked(found.value(), name, low, high);
}

std::optional<std::int64_t> Element::number(std::int64_t low, std::int64_t high) const { return checked(text(), node_.name(), low, high); }

std::optional<std::int64_t> Element::number_of(const char* name, std::int64_t low, std::int64_t high) const {
    const auto found = child(name);
    if (!found || found.text().empty()) return std::nullopt;
    return found.number(low, high);
}

std::optional<std::int64_t> Element::required_number_of(const char* name, std::int64_t low, std::int64_t high) const {
    const auto found = child(name);
    if (found && !found.text().empty()) return found.number(low, high);
    problem("esi.missing", fmt::format("it has no {}", name),
            fmt::format("add <{0}>...</{0}>, or ask the vendor for a complete file", name));
    return std::nullopt;
}

std::optional<std::int64_t> Element::required_number_in(const char* name, std::int64_t low, std::int64_t high) const {
    const auto found = node_.attribute(name);
    if (found && !trimmed(found.value()).empty()) return checked(found.value(), name, low, high);
    problem("esi.missing", fmt::format("it has no attribute {}", name),
            fmt::format("add {}=\"...\", or ask the vendor for a complete file", name));
    return std::nullopt;
}

bool Element::flag(const char* name, bool otherwise) const {
    const auto found = node_.attribute(name);
    if (!found) return otherwise;
    if (const auto value = parse_flag(found.value())) return *value;
    problem("esi.number", fmt::format("{} is '{}', which is neither 0 nor 1", name, attribute(name).substr(0, 40)), "write 0 or 1");
    return otherwise;
}

void Element::problem(std::string code, std::string what, std::string remedy) const {
    auto& list = grave_ ? findings_->problems : findings_->remarks;
    if (list.size() >= most_findings) return;
    list.push_back({std::move(code), fmt::format("{} ({})", place(), path()), std::move(what), std::move(remedy)});
}

std::string Element::path() const {
    std::string path;
    for (auto node = node_; node && node.parent(); node = node.parent()) {
        path = path.empty() ? step(node) : step(node) + "/" + path;
        const std::string_view name = node.name();
        if (name == "Device" || name == "Module") break;
    }
    return path;
}

}  // namespace taktwerk::ecat::esi
