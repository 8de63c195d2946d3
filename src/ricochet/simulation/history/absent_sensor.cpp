#include "ricochet/simulation/history/sensor.hpp"

namespace ricochet {

namespace {

class AbsentSensor final : public Sensor {
 public:
  explicit AbsentSensor(Columns columns) : columns_(std::move(columns)) {}
  [[nodiscard]] Columns columns() const override { return columns_; }
  void observe(const Observation&, std::vector<double>& row) override { row.insert(row.end(), columns_.size(), 0.0); }

 private:
  Columns columns_;
};

}  // namespace

std::unique_ptr<Sensor> make_absent_sensor(Columns columns) {
  return std::make_unique<AbsentSensor>(std::move(columns));
}

}  // namespace ricochet
