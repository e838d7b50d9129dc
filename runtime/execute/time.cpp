#include "execute/time.hpp"

#include <limits>

namespace bodeflow::execute {
namespace {

using Wide = __int128;

Time reduced(Wide num, Wide den) {
  Wide a = num < 0 ? -num : num, b = den;
  while (b != 0) {
    const Wide rest = a % b;
    a = b;
    b = rest;
  }
  return a > 1 ? Time{num / a, den / a} : Time{num, den};
}

}  // namespace

Time time_of(std::int64_t position, const Rate& rate) { return reduced(Wide{position} * rate.den, rate.num); }

Time multiple_of(std::int64_t count, const Rate& seconds) { return reduced(Wide{count} * seconds.num, seconds.den); }

Time later(const Time& time, const Rate& seconds) {
  if (seconds.num == 0) return time;
  // Whole seconds apart, so that the products stay small.
  const Wide whole = time.num / time.den + seconds.num / seconds.den;
  const Wide a = time.num % time.den, b = seconds.num % seconds.den;
  const Time rest = reduced(a * seconds.den + b * time.den, time.den * seconds.den);
  return reduced(whole * rest.den + rest.num, rest.den);
}

bool operator<(const Time& a, const Time& b) {
  Wide an = a.num, ad = a.den, bn = b.num, bd = b.den;
  bool swapped = false;
  while (true) {
    const Wide qa = an / ad, qb = bn / bd;
    if (qa != qb) return swapped ? qb < qa : qa < qb;
    const Wide ra = an % ad, rb = bn % bd;
    if (ra == 0 || rb == 0) return swapped ? (rb == 0 && ra != 0) : (ra == 0 && rb != 0);
    // ra/ad < rb/bd exactly when bd/rb < ad/ra
    an = ad;
    ad = ra;
    bn = bd;
    bd = rb;
    swapped = !swapped;
  }
}

std::int64_t first_firing(const Time& time, const Rate& rate) {
  const Wide whole = time.num / time.den * rate.num;
  const Wide part = time.num % time.den * rate.num;
  const Wide rest = whole % rate.den + part / time.den;
  const bool up = part % time.den != 0 || rest % rate.den != 0;
  const Wide index = whole / rate.den + rest / rate.den + (up ? 1 : 0);
  constexpr auto most = std::numeric_limits<std::int64_t>::max();
  return index > most ? most : static_cast<std::int64_t>(index);
}

double seconds(const Time& time) { return static_cast<double>(time.num) / static_cast<double>(time.den); }

}  // namespace bodeflow::execute
