#pragma once
// A text taken apart word by word; once one does not fit, none does any more.

#include <charconv>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace taktwerk::runtime {

class Words {
public:
    explicit Words(std::string_view text) : rest_(text) {}

    std::string_view next() {
        const auto from = rest_.find_first_not_of(" \n");
        if (from == std::string_view::npos) {
            rest_ = {};
            good_ = false;
            return {};
        }
        const auto to = rest_.find_first_of(" \n", from);
        const auto word = rest_.substr(from, to == std::string_view::npos ? to : to - from);
        rest_ = to == std::string_view::npos ? std::string_view{} : rest_.substr(to);
        return word;
    }
    void expect(std::string_view word) { good_ = next() == word && good_; }
    template <class T>
    void read(T& out, int base = 10) {
        const auto word = next();
        const char *begin = word.data(), *stop = begin + word.size();
        std::from_chars_result result{};
        if constexpr (std::is_integral_v<T>) result = std::from_chars(begin, stop, out, base);
        else result = std::from_chars(begin, stop, out);
        refuse_unless(!word.empty() && result.ec == std::errc{} && result.ptr == stop);
    }
    void read_bit(bool& out) {
        int value = 0;
        read(value);
        refuse_unless(value == 0 || value == 1);
        out = value == 1;
    }
    void refuse_unless(bool fits) { good_ = good_ && fits; }
    [[nodiscard]] bool at_end() const { return rest_.find_first_not_of(" \n") == std::string_view::npos; }
    [[nodiscard]] bool good() const { return good_; }

private:
    std::string_view rest_;
    bool good_ = true;
};

}  // namespace taktwerk::runtime
