#include "hmi_bridge/views/view_answers.hpp"

#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "hmi_bridge/views/image_file.hpp"
#include "hmi_bridge/views/view_check.hpp"

namespace taktwerk::hmi {

namespace {

using Json = nlohmann::ordered_json;
using Form = ViewValue::Form;
using Kind = ViewWidget::Kind;

std::string base64(std::string_view bytes) {
    static constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? letters[three >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

Json text_json(const LocalText& text) { return Json{{"en", text.english}, {"zh", text.chinese}}; }

std::string_view word_of(Form form) noexcept {
    switch (form) {
        case Form::number: return "number";
        case Form::flag: return "flag";
        case Form::word: break;
    }
    return "word";
}

std::string_view word_of(ViewWidget::Tone tone) noexcept {
    switch (tone) {
        case ViewWidget::Tone::good: return "good";
        case ViewWidget::Tone::warn: return "warn";
        case ViewWidget::Tone::bad: break;
    }
    return "bad";
}

Json value_json(const ViewValue& value) {
    Json out{{"name", value.name},          {"source", word(value.source)}, {"of", value.of},      {"member", value.member},
             {"form", word_of(value.form)}, {"unit", value.unit},           {"whole", value.whole}};
    if (value.minimum) out["minimum"] = *value.minimum;
    if (value.maximum) out["maximum"] = *value.maximum;
    if (value.writable) out["writable"] = true;
    return out;
}

Json widget_json(const ViewWidget& widget, const ViewValues& values) {
    Json out{{"kind", word(widget.kind)}, {"label", text_json(widget.label)}};
    if (widget.kind == Kind::axis) out["axis"] = widget.names.front().text;
    else if (!widget.names.empty()) {
        auto& all = out["values"] = Json::array();
        for (const auto& name : widget.names)
            if (const auto* value = values.find(name.text)) all.push_back(value_json(*value));
    }
    if (widget.minimum) out["minimum"] = *widget.minimum;
    if (widget.maximum) out["maximum"] = *widget.maximum;
    if (widget.decimals) out["decimals"] = *widget.decimals;
    if (widget.width != 0) out["width"] = widget.width;
    if (widget.kind == Kind::lamp) out["tone"] = word_of(widget.tone);
    if (widget.kind == Kind::trend) out["seconds"] = widget.seconds;
    if (widget.kind == Kind::image) {
        out["image"] = widget.image;
        auto& placed = out["placed"] = Json::array();
        for (const auto& one : widget.placed) {
            auto json = widget_json(one, values);
            json["x"] = one.x;
            json["y"] = one.y;
            placed.push_back(std::move(json));
        }
    }
    return out;
}

}  // namespace

Result<ViewAnswers> ViewAnswers::make(const std::vector<View>& views, const ViewValues& values) {
    if (auto errors = check(views, values); !errors.empty()) return errors.front();
    ViewAnswers out;
    auto all = Json::array();
    for (const auto& view : views) {
        Json one{{"name", view.name}, {"title", text_json(view.title)}};
        auto& rows = one["rows"] = Json::array();
        for (const auto& row : view.rows) {
            auto& widgets = rows.emplace_back(Json::array());
            for (const auto& widget : row) {
                widgets.push_back(widget_json(widget, values));
                if (widget.kind != Kind::image || out.images_.contains(widget.image)) continue;
                const auto image = read_image(widget.image_path);
                if (!image) {
                    auto error = image.error();
                    error.subject = widget.where;
                    return error;
                }
                out.images_[widget.image] = fmt::format(R"("media_type":"{}","data":"{}")", image->type, base64(image->bytes));
            }
        }
        all.push_back(std::move(one));
    }
    out.views_ = all.dump(-1, ' ', false, Json::error_handler_t::replace);
    return out;
}

std::optional<std::string_view> ViewAnswers::image(std::string_view name) const {
    const auto found = images_.find(name);
    if (found == images_.end()) return std::nullopt;
    return found->second;
}

std::vector<std::string> ViewAnswers::images() const {
    std::vector<std::string> out;
    for (const auto& [name, answer] : images_) out.push_back(name);
    return out;
}

}  // namespace taktwerk::hmi
