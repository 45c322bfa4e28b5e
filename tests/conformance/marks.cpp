#include "tests/conformance/marks.hpp"

#include <algorithm>
#include <regex>
#include <sstream>

namespace taktwerk::conformance {
namespace {

struct Test {
    std::string name;
    std::size_t first = 0, last = 0;  ///< lines, from the comment above to the closing brace
};

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

std::size_t line_at(const std::string& text, std::size_t at) {
    return 1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

/// Past the brace that closes the first one after `at`.
std::size_t end_of_body(const std::string& code, std::size_t at) {
    int depth = 0;
    for (std::size_t i = code.find('{', at); i < code.size(); ++i) {
        if (code[i] == '{') ++depth;
        if (code[i] == '}' && --depth == 0) return i;
    }
    return code.size();
}

std::vector<Test> tests_of(const std::string& code, const std::vector<std::string>& comments) {
    static const std::regex head(R"re(\b(?:TYPED_)?TEST(?:_F|_P)?\s*\(\s*(\w+)\s*,\s*(\w+)\s*\))re");
    std::vector<Test> tests;
    for (std::sregex_iterator at(code.begin(), code.end(), head), end; at != end; ++at) {
        const auto place = static_cast<std::size_t>(at->position());
        Test test{(*at)[1].str() + "." + (*at)[2].str(), line_at(code, place), line_at(code, end_of_body(code, place))};
        const auto only_comment = [&](std::size_t line) {
            return line >= 1 && line <= comments.size() && comments[line - 1].find_first_not_of(' ') == 0;
        };
        while (only_comment(test.first - 1)) --test.first;
        tests.push_back(test);
    }
    return tests;
}

/// What stands in comments, at its place; blanks elsewhere.
std::string comments_of(const std::string& text) {
    std::string comments = text;
    const std::string code = architecture::code_of(text, architecture::Literals::keep);
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] != '\n' && code[i] == text[i]) comments[i] = ' ';
    return comments;
}

}  // namespace

std::vector<Mark> marks_of(const architecture::SourceFile& file, const std::string& document) {
    const std::regex named("\\b" + document + R"re(-(\d+)(?:\s*\.\.\s*(?:\w+-)?(\d+))?)re");
    const auto comments = lines_of(comments_of(file.text));
    const auto tests = tests_of(architecture::code_of(file.text, architecture::Literals::blank), comments);
    std::vector<Mark> marks;
    for (std::size_t line = 1; line <= comments.size(); ++line) {
        const auto& text = comments[line - 1];
        for (std::sregex_iterator at(text.begin(), text.end(), named), end; at != end; ++at) {
            const int first = std::stoi((*at)[1]);
            const int last = (*at)[2].matched ? std::stoi((*at)[2]) : first;
            const auto inside = std::find_if(tests.begin(), tests.end(), [&](const Test& t) { return t.first <= line && line <= t.last; });
            for (int clause = first; clause <= last; ++clause) {
                Mark mark{clause, inside == tests.end() ? std::string{} : inside->name, file.path, line};
                const auto same = [&](const Mark& m) { return m.clause == clause && m.test == mark.test; };
                if (mark.test.empty() || std::none_of(marks.begin(), marks.end(), same)) marks.push_back(mark);
            }
        }
    }
    return marks;
}

}  // namespace taktwerk::conformance
