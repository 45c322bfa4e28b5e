#include "hmi_bridge/views/view_check.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/nearest_name.hpp"
#include "hmi_bridge/views/image_file.hpp"

namespace taktwerk::hmi {

namespace {

using Form = ViewValue::Form;
using Kind = ViewWidget::Kind;
using Source = ViewValue::Source;

std::string listed(const std::vector<std::string>& names) {
    std::string out;
    const auto most = std::min<std::size_t>(names.size(), 16);
    for (std::size_t i = 0; i < most; ++i) out += (out.empty() ? "" : ", ") + names[i];
    if (names.size() > most) out += ", ...";
    return out.empty() ? "none" : out;
}

class ViewCheck {
public:
    explicit ViewCheck(const ViewValues& values) : values_(values) {}

    std::vector<Error> run(const std::vector<View>& views) {
        for (const auto& view : views)
            for (const auto& row : view.rows)
                for (const auto& widget : row) look(widget);
        return std::move(errors_);
    }

private:
    void add(const std::string& where, std::string code, std::string what, std::string remedy) {
        errors_.push_back({std::move(code), where, std::move(what), std::move(remedy)});
    }

    void look(const ViewWidget& widget) {
        if (widget.kind == Kind::image && !values_.with_programs && !widget.image_path.empty()) {
            if (auto image = read_image(widget.image_path); !image) {
                const auto& error = image.error();
                add(widget.where, error.code, fmt::format("picture '{}': {}", widget.image, error.what), error.remedy);
            }
        }
        for (const auto& placed : widget.placed) look(placed);
        for (const auto& name : widget.names) {
            if (widget.kind == Kind::axis) axis(name);
            else value(widget, name);
        }
    }

    void axis(const ViewName& name) {
        if (values_.with_programs || std::ranges::find(values_.axes, name.text) != values_.axes.end()) return;
        const auto near = nearest_name(name.text, values_.axes);
        add(name.where, "view.unknown_name", fmt::format("there is no axis '{}' (there is: {})", name.text, listed(values_.axes)),
            near.empty() ? "correct the name" : fmt::format("did you mean `{}`?", near));
    }

    void value(const ViewWidget& widget, const ViewName& name) {
        if (values_.of_program(name.text) != values_.with_programs) return;
        const auto* found = values_.find(name.text);
        if (found == nullptr) return unknown(name);
        if (std::ranges::count(values_.all, name.text, &ViewValue::name) > 1)
            return add(name.where, "view.ambiguous", fmt::format("'{}' is a variable and a parameter of its program", name.text),
                       "give one of them another name in the program");
        fits(widget, name, *found);
    }

    void unknown(const ViewName& name) {
        std::vector<std::string> all, alike;
        const auto prefix = name.text.substr(0, name.text.find('.') + 1);
        for (const auto& one : values_.all) {
            all.push_back(one.name);
            if (!prefix.empty() && one.name.starts_with(prefix)) alike.push_back(one.name);
        }
        if (alike.empty()) {  // not even what stands before the dot
            for (const auto& one : values_.axes) alike.push_back(one + ".actual_position");
            for (const auto& one : values_.programs) alike.push_back(one + ".VARIABLE");
            alike.insert(alike.end(), {"in.INPUT", "out.OUTPUT", "machine.mode"});
        }
        const auto near = nearest_name(name.text, all);
        add(name.where, "view.unknown_name", fmt::format("this machine has no value '{}' (it has: {})", name.text, listed(alike)),
            near.empty() ? "correct the name" : fmt::format("did you mean `{}`?", near));
    }

    void fits(const ViewWidget& widget, const ViewName& name, const ViewValue& found) {
        const auto misfit = [&](std::string what, std::string remedy) {
            add(name.where, "view.misfit", std::move(what), std::move(remedy));
        };
        const auto& called = name.text;
        switch (widget.kind) {
            case Kind::lamp:
                if (found.form == Form::word)
                    misfit(fmt::format("'{}' is a word: a lamp is on or off", called), fmt::format("write `value: {}`", called));
                break;
            case Kind::button:
                if (!found.momentary)
                    misfit(fmt::format("'{}' is not pressed and held by people", called),
                           found.writable && found.form == Form::flag ? fmt::format("write `switch: {}`, which stays", called)
                                                                      : "declare it in the program by d.operator_button(...)");
                break;
            case Kind::toggle:
                if (!found.writable || found.form != Form::flag || found.momentary)
                    misfit(fmt::format("'{}' is not switched by people", called),
                           found.momentary ? fmt::format("write `button: {}`, which is held", called)
                                           : "declare it in the program by d.operator_switch(...)");
                break;
            case Kind::set:
                if (!found.writable || found.form != Form::number)
                    misfit(fmt::format("'{}' is no number that people write", called),
                           "declare it in the program by d.operator_value(...) or d.parameter(...)");
                break;
            case Kind::bar: bar(widget, name, found); break;
            case Kind::trend:
                if (found.form == Form::word || !found.recorded)
                    misfit(fmt::format("'{}' is not recorded in each cycle", called), "name another value, such as one of a program");
                break;
            default: break;
        }
    }

    void bar(const ViewWidget& widget, const ViewName& name, const ViewValue& found) {
        if (found.form != Form::number)
            return add(name.where, "view.misfit", fmt::format("'{}' is no number: it has no bar", name.text),
                       fmt::format("write `{}: {}`", found.form == Form::flag ? "lamp" : "value", name.text));
        const auto low = widget.minimum ? widget.minimum : found.minimum, high = widget.maximum ? widget.maximum : found.maximum;
        if (!low || !high)
            return add(name.where, "view.range", fmt::format("'{}' has no range of its own: a bar needs both ends", name.text),
                       "add `minimum` and `maximum`, in its unit");
        if (!(*low < *high))
            add(name.where, "view.range", fmt::format("the bar of '{}' would go from {:g} to {:g}", name.text, *low, *high),
                "give a `minimum` below the `maximum`");
    }

    const ViewValues& values_;
    std::vector<Error> errors_;
};

}  // namespace

std::vector<Error> check(const std::vector<View>& views, const ViewValues& values) { return ViewCheck{values}.run(views); }

std::string_view word(Kind kind) noexcept {
    switch (kind) {
        case Kind::value: return "value";
        case Kind::lamp: return "lamp";
        case Kind::button: return "button";
        case Kind::toggle: return "switch";
        case Kind::set: return "set";
        case Kind::bar: return "bar";
        case Kind::trend: return "trend";
        case Kind::axis: return "axis";
        case Kind::text: return "text";
        case Kind::alarms: return "alarms";
        case Kind::image: break;
    }
    return "image";
}

std::string summary_of(const View& view) {
    std::size_t widgets = 0, writing = 0;
    for (const auto& row : view.rows)
        for (const auto& widget : row) {
            widgets += 1 + widget.placed.size();
            writing += widget.kind == Kind::button || widget.kind == Kind::toggle || widget.kind == Kind::set ? 1 : 0;
        }
    return fmt::format("{} row{}, {} widget{}, {} of them write{}", view.rows.size(), view.rows.size() == 1 ? "" : "s", widgets,
                       widgets == 1 ? "" : "s", writing, writing == 1 ? "s" : "");
}

}  // namespace taktwerk::hmi
