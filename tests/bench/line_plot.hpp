#pragma once
// Quantities over one common scale as a picture, each in a field of its own from 0 on, with the straight line through its last point: what grows
// in proportion lies on it.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace taktwerk::bench {

struct Line {
    std::string label;
    std::vector<std::pair<double, double>> points;
};

[[nodiscard]] inline std::string svg(const std::string& scale, const std::vector<Line>& lines) {
    constexpr double width = 300, height = 170, left = 20, top = 34, field = width + 2 * left, row = height + top + 40;
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        2 * field, row * static_cast<double>((lines.size() + 1) / 2));
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const double x0 = field * static_cast<double>(i % 2) + left, y0 = row * static_cast<double>(i / 2) + top + height;
        double most_x = 0, most_y = 0;
        for (const auto& [x, y] : lines[i].points) most_x = std::max(most_x, x), most_y = std::max(most_y, y);
        const auto px = [&](double x) { return x0 + width * x / most_x; };
        const auto py = [&](double y) { return y0 - height * y / most_y; };
        const auto& last = lines[i].points.back();
        out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" font-weight=\"bold\">{}</text>\n", x0, y0 - height - 14, lines[i].label);
        out += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}M{:.1f} {:.1f}V{:.1f}\" stroke=\"#999\"/>\n", x0, y0, x0 + width, x0, y0,
                           y0 - height);
        out += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#bbb\" stroke-dasharray=\"4 3\"/>\n", x0, y0, px(last.first),
                           py(last.second));
        std::string path;
        for (const auto& [x, y] : lines[i].points) {
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px(x), py(y));
            out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"#1f5fa8\"/>\n", px(x), py(y));
        }
        out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#1f5fa8\" stroke-width=\"1.5\"/>\n", path);
        out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"end\">{:.4g}</text>\n", px(last.first), py(last.second) - 8,
                           last.second);
        out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"end\">{:.0f} {}</text>\n", x0 + width, y0 + 16, most_x, scale);
    }
    return out + "</svg>\n";
}

}  // namespace taktwerk::bench
