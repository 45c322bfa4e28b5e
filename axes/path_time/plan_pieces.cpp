#include "axes/path_time/plan_pieces.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {
namespace {

constexpr double longest_run = 1e12;  // s: what takes longer is no motion
constexpr double most_parts = 2500;   // that a plan is cut into, beside its short ones

/// v2 on a cell: at its ends, and Bernstein's coefficient between them.
struct Span {
    double from, to;
    double first, middle, last;
};

/// At a share of its length; the same v2, by de Casteljau.
struct Halves {
    Span before, behind;
};
Halves halves_of(const Span& span, double to, double t) {
    const double one = (1 - t) * span.first + t * span.middle, two = (1 - t) * span.middle + t * span.last;
    const double cut = (1 - t) * one + t * two;
    return {{span.from, to, span.first, one, cut}, {to, span.to, cut, two, span.last}};
}

class Cutter {
public:
    Cutter(const TimedCurve& curve, RunPlan& out, double whole)
        : curve_(curve), out_(out), longest_(std::max(longest_piece, whole / most_parts)) {}

    void add(TimePiece piece) {
        piece.begin_time = time_;
        piece.part = curve_.part_at(piece.begin + piece.length / 2);
        time_ += piece.duration;
        out_.pieces.push_back(piece);
    }
    void cut(const Span& span) {
        const double lasts = duration_of(span), left = short_for - time_;
        if (longest_ <= longest_piece || left >= lasts) return in_parts(span, lasts, longest_piece);
        if (left <= 0) return in_parts(span, lasts, longest_);
        const double share = left / lasts;
        const auto [soon, later] = halves_of(span, span.from + share * (span.to - span.from), share);
        in_parts(soon, duration_of(soon), longest_piece);
        in_parts(later, duration_of(later), longest_);
    }
    [[nodiscard]] double time() const noexcept { return time_; }

private:
    static double duration_of(const Span& s) { return TimePiece::moving(s.from, s.to - s.from, s.first, s.middle, s.last).duration; }

    void in_parts(const Span& span, double lasts, double longest) {
        RunShape& shape = out_.shape;
        const double length = span.to - span.from, cuts = std::floor(lasts / longest);
        const auto parts = static_cast<int>(std::min(cuts, most_parts)) + 1;
        Span rest = span;
        for (int k = 0; k < parts; ++k) {
            Span own = rest;
            if (k + 1 < parts) {
                const auto both = halves_of(rest, span.from + length * (k + 1) / parts, 1.0 / (parts - k));
                own = both.before;
                rest = both.behind;
                rest.first = own.last;
            }
            add(TimePiece::moving(own.from, own.to - own.from, own.first, own.middle, own.last));
            shape.nodes.push_back(own.to);
            shape.squares.push_back(own.last);
            shape.middles.push_back(own.middle);
        }
    }

    const TimedCurve& curve_;
    RunPlan& out_;
    double longest_;
    double time_ = 0;
};

/// All cells of `found` from `first` on, into `out`, whose pieces and shape hold what stands before them.
bool cut_cells(const TimedCurve& curve, const RunShape& found, std::size_t first, const TimePiece* begins, const TimePiece& ends,
               RunPlan& out) {
    out.pieces.clear();
    RunShape& shape = out.shape;
    shape.nodes.assign(1, found.nodes[first]);
    shape.squares.assign(1, found.squares[first]);
    shape.middles.clear();
    double whole = 0;
    for (std::size_t c = first; c < found.middles.size(); ++c) whole += (found.nodes[c + 1] - found.nodes[c]) / std::sqrt(found.middles[c]);
    if (!(whole < longest_run)) return false;  // nor is what is no number
    Cutter cutter(curve, out, whole);
    if (begins != nullptr) cutter.add(*begins);
    for (std::size_t c = first; c < found.middles.size(); ++c)
        cutter.cut({found.nodes[c], found.nodes[c + 1], shape.squares.back(), found.middles[c], found.squares[c + 1]});
    cutter.add(ends);
    out.duration = cutter.time();
    shape.end = found.end;
    shape.velocity_factor = found.velocity_factor;
    shape.coarse = found.coarse;
    return true;
}

}  // namespace

bool cut_into_pieces(const TimedCurve& curve, double begin, double begin_length, double end_length, const RunShape& found, RunPlan& out) {
    const auto from = TimePiece::rest(TimePiece::Kind::from_rest, begin, begin_length, found.squares.front());
    const auto to = TimePiece::rest(TimePiece::Kind::to_rest, found.nodes.back(), end_length, found.squares.back());
    return cut_cells(curve, found, 0, begin_length > 0 ? &from : nullptr, to, out);
}

bool has_long_pieces(const RunPlan& plan, std::size_t piece, double soon) noexcept {
    double time = 0;
    for (std::size_t i = piece; i < plan.pieces.size() && time < soon; time += plan.pieces[i++].duration)
        if (plan.pieces[i].kind == TimePiece::Kind::moving && plan.pieces[i].duration > 1.5 * longest_piece) return true;
    return false;
}

bool cut_anew(const TimedCurve& curve, const RunPlan& plan, std::size_t piece, RunPlan& out) {
    const std::size_t cell = piece - (plan.pieces.front().kind == TimePiece::Kind::from_rest ? 1 : 0);
    out.found = cut_cells(curve, plan.shape, cell, nullptr, plan.pieces.back(), out);
    out.use = plan.use;
    out.cells = static_cast<int>(out.shape.middles.size());
    out.planned = out.steps = out.rounds = 0;
    return out.found;
}

}  // namespace taktwerk::axes
