#pragma once
// One element of the XML while it is read: what is missing or no number becomes a problem with its place, and what nobody asked for is
// counted. Inside of ecat/esi only.

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include "core/result.hpp"
#include "ecat/esi/esi_file.hpp"

namespace taktwerk::ecat::esi {

/// The text that was parsed, for places: "el3xxx.xml:120:8".
struct SourceText {
    std::string file;
    std::vector<std::size_t> line_ends{};  ///< offsets of the line feeds
    void find_lines(std::string_view utf8);
    [[nodiscard]] std::size_t line(pugi::xml_node node) const;
    [[nodiscard]] std::string place(std::ptrdiff_t offset) const;
};

/// What came up while a device was read.
struct Findings {
    std::vector<Error> problems, remarks;
    std::map<std::string, Unread> unread;
};

class Element {
public:
    /// `grave`: what is wrong in it makes the device unusable.
    Element(pugi::xml_node node, const SourceText& source, Findings& findings, bool grave = true)
        : node_(node), source_(&source), findings_(&findings), grave_(grave) {}

    [[nodiscard]] explicit operator bool() const noexcept { return !node_.empty(); }
    [[nodiscard]] pugi::xml_node node() const noexcept { return node_; }
    [[nodiscard]] std::size_t line() const { return source_->line(node_); }
    /// The same element, of which the device can do without.
    [[nodiscard]] Element can_do_without() const { return {node_, *source_, *findings_, false}; }

    /// Says which parts of it are read; all others are counted as unread.
    void knows(std::initializer_list<std::string_view> children, std::initializer_list<std::string_view> attributes = {}) const;

    [[nodiscard]] Element child(const char* name) const { return {node_.child(name), *source_, *findings_, grave_}; }
    [[nodiscard]] std::vector<Element> children(const char* name) const;
    /// Its own text on one line, comments left out, without blanks at the ends.
    [[nodiscard]] std::string text() const;
    [[nodiscard]] std::string text_of(const char* child) const { return this->child(child).text(); }
    [[nodiscard]] std::string attribute(const char* name) const;
    /// Of several elements with an LcId the English one (1033, then any English), then one without a language, Chinese (2052), the first.
    [[nodiscard]] std::string in_english(const char* child) const;
    [[nodiscard]] std::string in_chinese(const char* child) const;

    /// A number of an attribute, of a child's text, of its own text. Nothing: it is not there, or it is none in the range: a problem.
    [[nodiscard]] std::optional<std::int64_t> number_in(const char* attribute, std::int64_t low, std::int64_t high) const;
    [[nodiscard]] std::optional<std::int64_t> number_of(const char* child, std::int64_t low, std::int64_t high) const;
    [[nodiscard]] std::optional<std::int64_t> number(std::int64_t low, std::int64_t high) const;
    /// As number_of, and a problem when it is not there.
    [[nodiscard]] std::optional<std::int64_t> required_number_of(const char* child, std::int64_t low, std::int64_t high) const;
    [[nodiscard]] std::optional<std::int64_t> required_number_in(const char* attribute, std::int64_t low, std::int64_t high) const;
    [[nodiscard]] bool flag(const char* attribute, bool otherwise = false) const;

    void problem(std::string code, std::string what, std::string remedy) const;
    /// "Device 'EL3104'/TxPdo[2]/Index"
    [[nodiscard]] std::string path() const;
    [[nodiscard]] std::string place() const { return source_->place(node_.offset_debug()); }

private:
    [[nodiscard]] std::optional<std::int64_t> checked(std::string_view text, const std::string& what, std::int64_t low,
                                                      std::int64_t high) const;

    pugi::xml_node node_;
    const SourceText* source_;
    Findings* findings_;
    bool grave_;
};

}  // namespace taktwerk::ecat::esi
