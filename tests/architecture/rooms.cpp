#include "tests/architecture/rooms.hpp"

#include <algorithm>
#include <cctype>
#include <regex>

namespace taktwerk::architecture {
namespace {

constexpr auto nowhere = std::string_view::npos;

bool of_a_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

bool word_stands(std::string_view code, std::size_t at, std::string_view word) {
    return code.substr(at, word.size()) == word && (at == 0 || !of_a_word(code[at - 1])) &&
           (at + word.size() >= code.size() || !of_a_word(code[at + word.size()]));
}

/// Past the bracket that closes the one at `at`.
std::size_t past_bracket(std::string_view code, std::size_t at) {
    const char open = code[at], close = open == '{' ? '}' : open == '(' ? ')' : open == '[' ? ']' : '>';
    std::size_t depth = 0;
    for (std::size_t i = at; i < code.size(); ++i) {
        if (code[i] == open) ++depth;
        if (code[i] == close && --depth == 0) return i + 1;
    }
    return code.size();
}

/// Code without what could be taken for a class or a member and is none: preprocessor lines, attributes, alignas(), the heads of templates.
std::string bare_code(std::string_view text) {
    std::string code = code_of(text, Literals::blank);
    const auto blank = [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i)
            if (code[i] != '\n') code[i] = ' ';
    };
    for (std::size_t i = 0; i < code.size(); ++i) {
        if (code[i] == '#') {
            auto end = code.find('\n', i);
            while (end != std::string::npos && code[end - 1] == '\\') end = code.find('\n', end + 1);
            blank(i, std::min(end, code.size()));
        } else if (code.compare(i, 2, "[[") == 0) {
            blank(i, past_bracket(code, i));
        } else if (word_stands(code, i, "alignas") || word_stands(code, i, "template")) {
            const auto bracket = code.find_first_of("(<", i);
            if (bracket != std::string::npos) blank(i, past_bracket(code, bracket));
        }
    }
    return code;
}

/// "class X ... {", not "class X;" nor "enum class X {". The brace; `nowhere` else.
std::size_t brace_of_class(std::string_view code, std::size_t at) {
    if (!word_stands(code, at, "class") && !word_stands(code, at, "struct") && !word_stands(code, at, "union")) return nowhere;
    const auto before = code.substr(0, at).find_last_not_of(" \t\n");
    if (before != nowhere && before >= 3 && word_stands(code, before - 3, "enum")) return nowhere;
    const auto found = code.find_first_of("{;()=", at);
    return found != nowhere && code[found] == '{' ? found : nowhere;
}

/// One declaration, read up to its semicolon or past its function body.
struct Declaration {
    std::string text;             ///< without arguments of templates, initialisers and what follows the first comma
    std::size_t declarators = 1;  ///< separated by commas
    bool function = false;
    std::size_t end = 0;
};

/// clang-format puts no blank in front of the bracket of arguments, and one in front of a comparison.
bool opens_arguments(std::string_view code, std::size_t at) {
    return code[at] == '<' && at > 0 && of_a_word(code[at - 1]) && code.substr(at, 2) != "<<";
}

Declaration read_declaration(std::string_view code, std::size_t at) {
    Declaration read;
    bool initialiser = false;
    for (std::size_t i = at; i < code.size(); ++i) {
        const char c = code[i];
        read.end = i + 1;
        if (c == ';') return read;
        if (opens_arguments(code, i)) {
            std::size_t depth = 0;
            for (; i < code.size(); ++i) {
                if (code[i] == '(') i = past_bracket(code, i) - 1;
                else if (code[i] == '<') ++depth;
                else if (code[i] == '>' && --depth == 0) break;
            }
        } else if (c == '(' || c == '[') {
            if (code.substr(i, 2) == "(*") initialiser = true;  // a pointer to a function
            if (c == '(' && !initialiser) read.function = true;
            i = past_bracket(code, i) - 1;
        } else if (c == '{') {
            i = past_bracket(code, i) - 1;
            const auto next = code.find_first_not_of(" \t\n", i + 1);
            // A constructor's body follows the initialisers of its members.
            if (read.function && (next == nowhere || (code[next] != ',' && code[next] != '{'))) {
                read.end = i + 1;
                return read;
            }
            initialiser = true;
        } else if (c == ',') {
            ++read.declarators;
            initialiser = false;
        } else if (c == '=') {
            initialiser = true;
        } else if (!initialiser && read.declarators == 1) {
            read.text += c;
        }
    }
    return read;
}

std::size_t data_members(const Declaration& read) {
    static const std::regex none(R"(^\s*(using|typedef|friend|static_assert|extern|explicit|virtual|requires)\b|\b(static|operator)\b)"
                                 R"(|^\s*(class|struct|union|enum)\s+[\w:]+\s*$|^\s*$)");
    return read.function || std::regex_search(read.text, none) ? 0 : read.declarators;
}

/// Reads a class whose keyword stands at `at` with what it holds; past its closing brace.
std::size_t read_class(std::string_view code, std::size_t at, std::size_t brace, std::vector<ClassRoom>& rooms) {
    static const std::regex head(R"(^(class|struct|union)\s+([\w:]+))");
    ClassRoom room;
    const std::string words(code.substr(at, brace - at));
    if (std::smatch match; std::regex_search(words, match, head)) room.name = match[2];
    room.line = 1 + static_cast<std::size_t>(std::count(code.begin(), code.begin() + static_cast<std::ptrdiff_t>(at), '\n'));

    static constexpr std::string_view labels[] = {"public", "protected", "private"};
    std::size_t i = brace + 1;
    while (i < code.size() && code[i] != '}') {
        if (std::isspace(static_cast<unsigned char>(code[i])) != 0 || code[i] == ':' || code[i] == ';') {
            ++i;
        } else if (const auto* label = std::find_if(std::begin(labels), std::end(labels), [&](auto l) { return word_stands(code, i, l); });
                   label != std::end(labels)) {
            i += label->size();
        } else if (const auto nested = brace_of_class(code, i); nested != nowhere) {
            i = read_class(code, i, nested, rooms);
            const auto rest = read_declaration(code, i);  // "} name_;" is a member of that class
            room.members += data_members(rest);
            i = rest.end;
        } else {
            if (word_stands(code, i, "enum")) {  // "enum X { a, b } name_;"
                const auto opened = code.find_first_of("{;", i);
                if (opened != nowhere && code[opened] == '{') i = past_bracket(code, opened);
            }
            const auto read = read_declaration(code, i);
            room.members += data_members(read);
            i = read.end;
        }
    }
    rooms.push_back(room);
    return i + 1;
}

std::string at_line(const SourceFile& file, std::size_t line) { return file.path + ":" + std::to_string(line) + ": "; }

bool is_header(const SourceFile& file) { return file.path.size() > 4 && file.path.substr(file.path.size() - 4) == ".hpp"; }

/// What is left to see of a list of leaves after all files were seen.
class Leaves {
public:
    explicit Leaves(const std::vector<Leave>& leaves) : leaves_(leaves), needed_(leaves.size(), false) {}

    /// `size` of this class or header may be.
    bool allow(const std::string& path, const std::string& name, std::size_t size) {
        for (std::size_t i = 0; i < leaves_.size(); ++i) {
            if (leaves_[i].path != path || leaves_[i].name != name) continue;
            needed_[i] = true;
            return size <= leaves_[i].most && !leaves_[i].reason.empty();
        }
        return false;
    }
    void report_idle(Violations& violations) const {
        for (std::size_t i = 0; i < leaves_.size(); ++i)
            if (!needed_[i])
                violations.push_back(leaves_[i].path + ": " + leaves_[i].name + " has leave to be larger and does not need it");
    }

private:
    const std::vector<Leave>& leaves_;
    std::vector<bool> needed_;
};

}  // namespace

std::vector<ClassRoom> class_rooms(std::string_view text) {
    const std::string code = bare_code(text);
    std::vector<ClassRoom> rooms;
    for (std::size_t i = 0; i < code.size();) {
        const auto brace = brace_of_class(code, i);
        i = brace == nowhere ? i + 1 : read_class(code, i, brace, rooms);
    }
    std::sort(rooms.begin(), rooms.end(), [](const auto& a, const auto& b) { return a.line < b.line; });
    return rooms;
}

Violations check_class_sizes(const std::vector<SourceFile>& files, const std::vector<Leave>& leaves) {
    Violations violations;
    Leaves left(leaves);
    for (const auto& file : files)
        for (const auto& room : class_rooms(file.text))
            if (room.members > most_members && !left.allow(file.path, room.name, room.members))
                violations.push_back(at_line(file, room.line) + room.name + " has " + std::to_string(room.members) +
                                     " data members: more than one idea");
    left.report_idle(violations);
    return violations;
}

Violations check_header_lengths(const std::vector<SourceFile>& files, const std::vector<Leave>& leaves) {
    Violations violations;
    Leaves left(leaves);
    for (const auto& file : files) {
        const auto lines = static_cast<std::size_t>(std::count(file.text.begin(), file.text.end(), '\n'));
        if (is_header(file) && lines > most_header_lines && !left.allow(file.path, "", lines))
            violations.push_back(file.path + " has " + std::to_string(lines) + " lines: more than one idea");
    }
    left.report_idle(violations);
    return violations;
}

}  // namespace taktwerk::architecture
