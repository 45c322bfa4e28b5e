#include "config/machine_file/cam_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "config/reading/document.hpp"
#include "config/reading/quantity.hpp"

namespace taktwerk::config {

namespace {

constexpr std::size_t most_errors = 10;  // of one file: the rest is the same mistake

struct Cell {
    std::string_view text;  // trimmed
    int column = 1;
};

std::string_view trimmed(std::string_view text) {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string shown_cell(std::string_view text) {
    std::string out;
    for (const char c : text.substr(0, 40)) out += static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E ? '?' : c;
    return text.size() > 40 ? out + "..." : out;
}

enum class Column : std::uint8_t { master, slave, velocity };
constexpr std::array<std::string_view, 3> column_names{"master", "slave", "velocity"};

class CamReading {
public:
    CamReading(const std::string& file, const CamUnits& units) : file_(file), units_(units) {}

    CamFile read(std::string_view text) {
        if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
        for (line_ = 1; !text.empty() && !over_; ++line_) {
            const auto end = text.find('\n');
            take(text.substr(0, end));
            text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        }
        if (!over_ && columns_.empty() && out_.errors.empty()) no_header({1, 1});
        if (!over_ && out_.errors.empty() && out_.points.size() < 2)
            fail({}, "cam_points",
                 fmt::format("the file has {} point{}, a cam needs two", out_.points.size(), out_.points.size() == 1 ? "" : "s"),
                 "add the points, one a line");
        return std::move(out_);
    }

private:
    void take(std::string_view line) {
        const auto content = trimmed(line);
        if (content.empty() || content.front() == '#') return;
        if (separator_ == 0) separator_ = line.find(';') != line.npos ? ';' : line.find('\t') != line.npos ? '\t' : ',';
        const auto cells = parted(line);
        if (columns_.empty()) take_header(cells);
        else take_row(cells);
    }

    std::vector<Cell> parted(std::string_view line) const {
        std::vector<Cell> cells;
        for (std::size_t begin = 0; begin <= line.size();) {
            const auto end = std::min(line.find(separator_, begin), line.size());
            const auto raw = line.substr(begin, end - begin);
            const auto text = trimmed(raw);
            const auto lead = text.empty() ? 0 : static_cast<std::size_t>(text.data() - raw.data());
            cells.push_back({text, static_cast<int>(begin + lead) + 1});
            begin = end + 1;
        }
        return cells;
    }

    void take_header(const std::vector<Cell>& cells) {
        if (!cells.front().text.empty() && parse_number(cells.front().text)) return no_header({line_, cells.front().column});
        for (const auto& cell : cells) {
            // `slave [mm]`, `slave (mm)`, `slave mm`
            auto name = cell.text.substr(0, cell.text.find_first_of(" [("));
            auto unit = trimmed(cell.text.substr(name.size()));
            if (unit.size() > 1 && ((unit.front() == '[' && unit.back() == ']') || (unit.front() == '(' && unit.back() == ')')))
                unit = trimmed(unit.substr(1, unit.size() - 2));
            const auto known = std::find(column_names.begin(), column_names.end(), name);
            if (known == column_names.end()) {
                fail({line_, cell.column}, "cam_header", fmt::format("`{}` is no column of a cam", shown_cell(cell.text)),
                     "name the columns master, slave and, where it is known, velocity: " + example());
                continue;
            }
            const auto column = static_cast<Column>(known - column_names.begin());
            if (std::find(columns_.begin(), columns_.end(), column) != columns_.end())
                fail({line_, cell.column}, "cam_header", fmt::format("the column `{}` stands here twice", name), "remove one of them");
            if (unit.empty() || !value_of(column, "1", unit))
                fail({line_, cell.column}, "cam_unit",
                     unit.empty()
                         ? fmt::format("the column `{}` has no unit", name)
                         : fmt::format("`{}` is no unit for the column `{}`: it is in {}", shown_cell(unit), name, unit_of_column(column)),
                     fmt::format("write it as `{} [{}]`", name, unit_of_column(column)));
            columns_.push_back(column);
            column_units_.emplace_back(unit);
        }
        for (const auto needed : {Column::master, Column::slave})
            if (out_.errors.empty() && std::find(columns_.begin(), columns_.end(), needed) == columns_.end())
                fail({line_, 1}, "cam_header", fmt::format("there is no column `{}`", column_names[static_cast<std::size_t>(needed)]),
                     "add it: " + example());
        out_.velocities = std::find(columns_.begin(), columns_.end(), Column::velocity) != columns_.end();
        over_ = !out_.errors.empty();  // without its columns no row means anything
    }

    void take_row(const std::vector<Cell>& cells) {
        if (cells.size() != columns_.size()) {
            const bool comma = separator_ == ',' && cells.size() == 2 * columns_.size();
            return fail({line_, cells.size() > columns_.size() ? cells[columns_.size()].column : 1}, "cam_row",
                        fmt::format("the line has {} value{}, the header {}", cells.size(), cells.size() == 1 ? "" : "s", columns_.size()),
                        comma ? "write numbers with a decimal point: 12.5" : "give a value for each column of the header");
        }
        axes::CamPoint point;
        bool good = true;
        int master_column = 1;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const auto number = parse_number(cells[i].text) ? value_of(columns_[i], cells[i].text, column_units_[i]) : std::nullopt;
            if (!number) {
                bad_number(cells[i]);
                good = false;
                continue;
            }
            const double value = *number;
            switch (columns_[i]) {
                case Column::master: point.master = value, master_column = cells[i].column; break;
                case Column::slave: point.slave = value; break;
                case Column::velocity: point.velocity = value; break;
            }
        }
        if (!good) return;
        if (!out_.points.empty() && !(point.master > out_.points.back().master))
            return fail({line_, master_column}, "cam_order",
                        fmt::format("the master's position {} {} is not above that of line {}, {}", show_number(point.master),
                                    units_.master, out_.lines.back(), show_number(out_.points.back().master)),
                        "sort the lines by the master's position, and give each once");
        if (out_.points.size() == max_cam_points) {
            fail({line_, 1}, "cam_too_long", fmt::format("the cam has more than {} points", max_cam_points),
                 "leave out points: curves run through those that are left");
            over_ = true;
            return;
        }
        out_.points.push_back(point);
        out_.lines.push_back(line_);
    }

    void bad_number(const Cell& cell) {
        std::string lower;
        for (const char c : cell.text) lower += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
        const auto bare =
            std::string_view(lower).substr(lower.find_first_not_of("+-") == std::string::npos ? 0 : lower.find_first_not_of("+-"));
        if (cell.text.empty()) return fail({line_, cell.column}, "cam_number", "there is no value", "give a number, or leave out the line");
        if (bare.substr(0, 3) == "nan" || bare.substr(0, 3) == "inf")
            return fail({line_, cell.column}, "cam_number", fmt::format("`{}` is no finite number", shown_cell(cell.text)),
                        "leave out points that are not known");
        fail({line_, cell.column}, "cam_number", fmt::format("`{}` is no number", shown_cell(cell.text)),
             cell.text.find(',') != std::string_view::npos ? "write it with a decimal point: 12.5"
                                                           : "write it such as 12.5 or -1e-3; units stand in the header");
    }

    [[nodiscard]] std::string unit_of_column(Column column) const {
        return column == Column::master ? units_.master : column == Column::slave ? units_.slave : unit_of_cam_derivative(1, units_);
    }
    /// In the axes' units.
    [[nodiscard]] std::optional<double> value_of(Column column, std::string_view number, const std::string_view unit) const {
        const auto text = fmt::format("{} {}", number, unit);
        if (column == Column::velocity) return parse_cam_derivative(text, 1, units_);
        const auto quantity = parse_quantity(text, Dimension::position, column == Column::master ? units_.master : units_.slave);
        if (quantity.problem != QuantityProblem::none) return std::nullopt;
        return quantity.value;
    }
    [[nodiscard]] std::string example() const {
        return fmt::format("`master [{}], slave [{}], velocity [{}]`", units_.master, units_.slave, unit_of_cam_derivative(1, units_));
    }

    void no_header(Position at) {
        fail(at, "cam_header", "there is no line that names the columns and their units",
             fmt::format("begin the file with `master [{}], slave [{}]`", units_.master, units_.slave));
        over_ = true;
    }
    void fail(Position at, std::string_view code, std::string what, std::string remedy) {
        if (out_.errors.size() == most_errors) {
            over_ = true;
            return;
        }
        out_.errors.push_back({fmt::format("config.{}", code), located(file_, at), std::move(what), std::move(remedy)});
    }

    const std::string& file_;
    const CamUnits& units_;
    CamFile out_;
    int line_ = 0;
    char separator_ = 0;
    std::vector<Column> columns_;
    std::vector<std::string> column_units_;
    bool over_ = false;
};

}  // namespace

CamFile parse_cam_file(const std::string& file, std::string_view text, const CamUnits& units) { return CamReading(file, units).read(text); }

CamFile read_cam_file(const std::string& path, const CamUnits& units) {
    auto text = read_text(path, "CSV", "; it is looked up from the machine file's folder");
    if (text) return parse_cam_file(path, *text, units);
    CamFile out;
    out.errors.push_back(text.error());
    return out;
}

std::string unit_of_cam_derivative(int order, const CamUnits& units) {
    return fmt::format("{}/{}{}", units.slave, units.master, order == 2 ? "2" : "");
}

std::optional<double> parse_cam_derivative(std::string_view text, int order, const CamUnits& units) {
    if (const auto bare = parse_number(text)) return units.master == units.slave ? bare : std::nullopt;
    const auto slash = text.find('/');
    if (slash == std::string_view::npos) return std::nullopt;
    const auto above = parse_quantity(text.substr(0, slash), Dimension::position, units.slave);
    auto below = trimmed(text.substr(slash + 1));
    if (order == 2) {
        if (below.empty() || below.back() != '2') return std::nullopt;
        below.remove_suffix(1);
        if (!below.empty() && below.back() == '^') below.remove_suffix(1);
    }
    const auto unit = parse_quantity("1 " + std::string(below), Dimension::position, units.master);
    if (above.problem != QuantityProblem::none || unit.problem != QuantityProblem::none) return std::nullopt;
    const double value = above.value / unit.value / (order == 2 ? unit.value : 1);
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace taktwerk::config
