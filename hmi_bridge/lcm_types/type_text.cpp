#include "hmi_bridge/lcm_types/type_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>

#include <fmt/format.h>

namespace taktwerk::hmi {
namespace {

constexpr std::size_t longest_text = std::size_t{1} << 20;
constexpr std::array<std::string_view, 9> primitives{"int8_t", "int16_t", "int32_t", "int64_t", "byte",
                                                     "float",  "double",  "string",  "boolean"};

struct Token {
    enum class Kind { end, word, sign, comment } kind = Kind::end;
    std::string_view text;
    int line = 1;
};

bool of_a_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-' || c == '+'; }

class Tokens {
public:
    explicit Tokens(std::string_view text) : text_(text) { advance(); }
    [[nodiscard]] const Token& now() const { return now_; }
    /// The comment behind what was read last, on its line; then it is passed over.
    std::string comment_on(int line) {
        std::string out;
        if (now_.kind == Token::Kind::comment && now_.line == line) out = std::string(now_.text);
        return out;
    }
    void advance() {
        skip_blanks();
        now_ = {Token::Kind::end, {}, line_};
        if (at_ >= text_.size()) return;
        const auto rest = text_.substr(at_);
        if (rest.starts_with("//")) {
            const auto end = std::min(rest.find('\n'), rest.size());
            auto words = rest.substr(2, end - 2);
            while (!words.empty() && std::isspace(static_cast<unsigned char>(words.front())) != 0) words.remove_prefix(1);
            while (!words.empty() && std::isspace(static_cast<unsigned char>(words.back())) != 0) words.remove_suffix(1);
            now_ = {Token::Kind::comment, words, line_};
            at_ += end;
        } else if (rest.starts_with("/*")) {
            const auto end = rest.find("*/", 2);
            const auto whole = rest.substr(0, end == std::string_view::npos ? rest.size() : end + 2);
            now_ = {Token::Kind::comment, {}, line_};
            line_ += static_cast<int>(std::count(whole.begin(), whole.end(), '\n'));
            at_ += whole.size();
        } else if (of_a_word(rest.front())) {
            std::size_t size = 1;
            while (size < rest.size() && of_a_word(rest[size])) ++size;
            now_ = {Token::Kind::word, rest.substr(0, size), line_};
            at_ += size;
        } else {
            now_ = {Token::Kind::sign, rest.substr(0, 1), line_};
            ++at_;
        }
    }

private:
    void skip_blanks() {
        for (; at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0; ++at_)
            if (text_[at_] == '\n') ++line_;
    }
    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
    Token now_;
};

class Parser {
public:
    Parser(std::string_view text, const std::string& file) : tokens_(text), file_(file) {}

    Result<std::vector<LcmType>> parse() {
        while (!error_ && skip_comments().kind != Token::Kind::end) {
            const auto what = word("`package` or `struct`");
            if (what == "package") {
                package_ = word("the package's name");
                sign(";");
            } else if (what == "struct") {
                read_struct();
            } else if (!error_) {
                wrong(fmt::format("'{}' is neither `package` nor `struct`", what));
            }
        }
        if (error_) return *error_;
        return std::move(types_);
    }

private:
    const Token& skip_comments() {
        while (tokens_.now().kind == Token::Kind::comment) tokens_.advance();
        return tokens_.now();
    }
    void wrong(std::string what) {
        if (!error_)
            error_ = Error{"lcm.type_text", fmt::format("{}:{}", file_, tokens_.now().line), std::move(what),
                           "Compare it with what lcm-gen takes."};
    }
    std::string word(const char* wanted) {
        const auto& token = skip_comments();
        if (token.kind != Token::Kind::word) {
            wrong(fmt::format("here should be {}", wanted));
            return {};
        }
        std::string out(token.text);
        line_ = token.line;
        tokens_.advance();
        return out;
    }
    bool taken(std::string_view wanted) {
        const auto& token = skip_comments();
        if (token.kind != Token::Kind::sign || token.text != wanted) return false;
        line_ = token.line;
        tokens_.advance();
        return true;
    }
    void sign(const char* wanted) {
        if (!taken(wanted)) wrong(fmt::format("here should be '{}'", wanted));
    }
    static std::optional<std::int64_t> whole(std::string_view text) {
        std::int64_t value = 0;
        const bool hex = text.starts_with("0x") || text.starts_with("0X");
        const auto digits = hex ? text.substr(2) : text;
        const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), value, hex ? 16 : 10);
        if (failed != std::errc{} || end != digits.data() + digits.size() || digits.empty()) return std::nullopt;
        return value;
    }
    void read_constants(LcmType& type) {
        word("the constant's type");
        do {
            LcmConstant constant;
            constant.name = word("the constant's name");
            sign("=");
            const auto value = whole(word("its value"));
            if (value) {
                constant.value = *value;
                type.constants.push_back(std::move(constant));
            }
        } while (!error_ && taken(","));
        sign(";");
    }
    void read_fields(LcmType& type, std::string kind) {
        if (!is_primitive(kind) && kind.find('.') == std::string::npos && !package_.empty()) kind = package_ + "." + kind;
        const auto first = type.fields.size();
        do {
            LcmField field;
            field.type = kind;
            field.name = word("the field's name");
            while (!error_ && taken("[")) {
                LcmDimension dimension;
                dimension.size = word("the array's size");
                if (const auto fixed = whole(dimension.size)) {
                    dimension.fixed = *fixed;
                    if (*fixed < 0) wrong("an array's size is not negative");
                } else if (std::none_of(type.fields.begin(), type.fields.end(),
                                        [&](const LcmField& f) { return f.name == dimension.size; })) {
                    wrong(fmt::format("the array's size '{}' is no field that stands before it", dimension.size));
                }
                sign("]");
                field.dimensions.push_back(std::move(dimension));
            }
            type.fields.push_back(std::move(field));
        } while (!error_ && taken(","));
        sign(";");
        const auto comment = tokens_.comment_on(line_);
        for (auto i = first; i < type.fields.size(); ++i) type.fields[i].comment = comment;
    }
    void read_struct() {
        LcmType type;
        type.package = package_;
        type.name = word("the struct's name");
        sign("{");
        while (!error_ && !taken("}")) {
            const auto kind = word("a field's type");
            if (kind == "const") read_constants(type);
            else read_fields(type, kind);
        }
        types_.push_back(std::move(type));
    }

    Tokens tokens_;
    const std::string& file_;
    std::string package_;
    int line_ = 1;  // of what was taken last
    std::vector<LcmType> types_;
    std::optional<Error> error_;
};

}  // namespace

bool is_primitive(std::string_view type) noexcept { return std::find(primitives.begin(), primitives.end(), type) != primitives.end(); }

Result<std::vector<LcmType>> parse_lcm_text(std::string_view text, const std::string& file) {
    if (text.size() > longest_text) return Error{"lcm.type_text", file, "the file is longer than 1 MiB", "A type takes a page."};
    return Parser(text, file).parse();
}

}  // namespace taktwerk::hmi
