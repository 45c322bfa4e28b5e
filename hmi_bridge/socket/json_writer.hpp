#pragma once
// JSON text straight into a string, for what is made many times a second: no tree of values in between. Numbers with the fewest digits that read
// back as the same number; those that JSON has no word for as json_number.hpp has them. Not real-time.
//
//   JsonWriter json;
//   json.open('{');
//   json.field("name", axis.name);
//   json.open("alarms", '[');  json.value(1.5);  json.close(']');
//   json.close('}');
//   send(json.take());

#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace taktwerk::hmi {

class JsonWriter {
public:
    explicit JsonWriter(std::size_t expected = 256) { text_.reserve(expected); }

    void open(char bracket) {
        separate();
        text_ += bracket;
        first_ = true;
    }
    void open(std::string_view key, char bracket) {
        this->key(key);
        text_ += bracket;
        first_ = true;
    }
    void close(char bracket) {
        text_ += bracket;
        first_ = false;
    }
    /// A key of our own: letters and underscores. Names of others: name().
    void key(std::string_view key) {
        separate();
        text_ += '"';
        text_ += key;
        text_ += "\":";
        first_ = true;  // nothing between it and its value
    }
    void name(std::string_view key) {
        separate();
        put_text(key);
        text_ += ':';
        first_ = true;
    }

    void value(bool value) { put(value ? "true" : "false"); }
    void value(std::string_view value) {
        separate();
        put_text(value);
    }
    void value(const std::string& value) { this->value(std::string_view(value)); }
    void value(const char* value) { this->value(std::string_view(value)); }
    template <std::integral Number>
    void value(Number value) {
        put_number(value);
    }
    void value(double value) {
        if (std::isfinite(value)) put_number(value);
        else put(std::isnan(value) ? "\"NaN\"" : value > 0 ? "\"Infinity\"" : "\"-Infinity\"");
    }
    /// null: there is none.
    void value(std::nullopt_t) { put("null"); }
    /// A value that is JSON already.
    void raw(std::string_view json) { put(json); }

    template <class Value>
    void field(std::string_view key, const Value& value) {
        this->key(key);
        this->value(value);
    }

    [[nodiscard]] std::string take() { return std::move(text_); }

private:
    void separate() {
        if (!first_) text_ += ',';
        first_ = false;
    }
    void put(std::string_view word) {
        separate();
        text_ += word;
    }
    template <class Number>
    void put_number(Number number) {
        char digits[32];
        const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
        put({digits, static_cast<std::size_t>(end - digits)});
    }
    void put_text(std::string_view text);

    std::string text_;
    bool first_ = true;
};

}  // namespace taktwerk::hmi
