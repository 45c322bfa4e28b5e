#pragma once
// A YAML text as a tree that remembers where everything stood. The only place that sees yaml-cpp; whatever the text holds,
// the answer is a tree or errors, never an exception. Anchors and aliases are expanded, within bounds.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::config {

/// 1-based; line 0 = the file as a whole.
struct Position {
    int line = 0, column = 0;
    friend bool operator==(const Position&, const Position&) = default;
    friend bool operator<(const Position& a, const Position& b) noexcept {
        return a.line != b.line ? a.line < b.line : a.column < b.column;
    }
};

struct Entry;

struct Node {
    enum class Kind : std::uint8_t { null, scalar, list, map };
    Kind kind = Kind::null;
    std::string text;     ///< scalar
    bool quoted = false;  ///< scalar: was written in quotes, so it is a text whatever it looks like
    Position at;
    std::vector<Node> items;     ///< list
    std::vector<Entry> entries;  ///< map, in the order of the file, each key once

    [[nodiscard]] const Node* find(std::string_view key) const noexcept;
};

struct Entry {
    std::string key;
    Position at;
    Node value;
};

[[nodiscard]] std::string_view describe(const Node& node) noexcept;  ///< "a list", "a text", ...

// Bounds: a configuration is written by people; what exceeds them is an accident or an attack.
inline constexpr std::size_t max_file_bytes = 1u << 20;
inline constexpr std::size_t max_nodes = 100'000;  ///< after expanding aliases
inline constexpr int max_depth = 40;

/// `file` is only for messages. On errors the tree is what could be read (duplicate keys keep the first).
struct Document {
    std::string file;
    Node root;
    std::vector<Error> errors;
    std::string based_on{};  ///< path of the file that another reader put beneath it (drive files); empty: none
};

/// Errors: config.encoding, config.too_large, config.syntax, config.too_deep, config.too_many_nodes, config.duplicate_key,
/// config.empty, config.several_documents.
[[nodiscard]] Document parse_document(std::string file, std::string_view text);

/// The whole of a file of at most `most` bytes. `kind` and `where` are for messages: "YAML"; "; it is looked up from ...".
/// Errors: config.no_file, config.not_a_file, config.too_large, config.unreadable.
[[nodiscard]] Result<std::string> read_text(const std::string& path, std::string_view kind, std::string_view where = {},
                                            std::size_t most = max_file_bytes);

/// Reads and parses. Further errors: config.no_file, config.not_a_file, config.unreadable.
[[nodiscard]] Document read_document(const std::string& path);

/// "file:line:col", or "file" alone for line 0.
[[nodiscard]] std::string located(std::string_view file, Position at);

}  // namespace taktwerk::config
