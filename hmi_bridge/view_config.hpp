#pragma once
// The machine builder's own pages (`views:`): rows of widgets that show and write values of the machine. Plain data; config/ fills it. What a
// name means and what is wrong with it: hmi_bridge/views/.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace taktwerk::hmi {

/// For people, in the page's two languages; written once, it is both.
struct LocalText {
    std::string english, chinese;
};

/// A value of the machine as it is written ("x.actual_position"), and where.
struct ViewName {
    std::string text;
    std::string where{};  ///< "machine.yaml:12:5"
};

struct ViewWidget {
    enum class Kind : std::uint8_t { value, lamp, button, toggle, set, bar, trend, axis, text, alarms, image };
    Kind kind = Kind::value;
    std::vector<ViewName> names;  ///< what it shows or writes; a trend: one to eight; an axis: its name; text, alarms, image: none
    LocalText label;              ///< of a text: itself; empty: the value's own name
    std::optional<double> minimum, maximum;  ///< of a bar, a trend; nothing: the value's own
    std::optional<std::uint8_t> decimals;    ///< nothing: as many as the value needs
    enum class Tone : std::uint8_t { good, warn, bad };
    Tone tone = Tone::good;            ///< of a lamp that is on
    std::uint16_t seconds = 20;        ///< that a trend shows
    std::uint8_t width = 0;            ///< of twelve columns; 0: what the others leave, in equal parts
    std::string image{};               ///< its file as it is written, beside the machine file
    std::string image_path{};          ///< where that is; empty: not where it may be, which has been said
    std::vector<ViewWidget> placed{};  ///< values and lamps on the image ...
    double x = 0, y = 0;               ///< ... and where: percent of its width and height
    std::string where{};
};

struct View {
    std::string name;
    LocalText title;
    std::vector<std::vector<ViewWidget>> rows;
    std::string where{};
};

}  // namespace taktwerk::hmi
