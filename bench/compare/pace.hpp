#pragma once

namespace slipstick::bench {

/// Seconds of four bare transforms by FFTW, on fields of 128 x 128 cells: nothing of this project, so that
/// what it tells is how quickly the machine works just now. On machines that share their processors with
/// others that changes twofold within seconds, and no load average knows of it.
double pace_seconds();

/// Tells when the machine works as quickly as it can.
class Pace {
 public:
  /// reference: the least seconds that the same kind of machine took at another time; 0: not known.
  explicit Pace(double reference = 0.0);

  /// Whether it does now, within kSlack of the best seen so far.
  bool is_full();

  /// The least seconds seen by this object.
  double best() const { return best_; }
  double reference() const { return reference_; }
  /// The machine does not come near to what it did at the other time.
  bool is_below_reference() const;

  static constexpr double kSlack = 0.1;

 private:
  double reference_;
  double best_;
};

}  // namespace slipstick::bench
