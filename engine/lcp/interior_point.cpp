// proto
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstdio>
#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {
namespace {

struct Scaling { Mat3 f, inverse; Vec3 v; };  // F λ = F⁻¹ u = v

double det(const Vec3& x) { return (x.x() - std::hypot(x.y(), x.z())) * (x.x() + std::hypot(x.y(), x.z())); }

Scaling scale_of(const Vec3& l, const Vec3& u) {
  Scaling s;
  const double al = std::sqrt(det(l)), au = std::sqrt(det(u));
  const Vec3 sb = l / al, zb = u / au;
  const double gamma = std::sqrt(0.5 * (1.0 + sb.dot(zb)));
  Vec3 w = (sb + Vec3(zb.x(), -zb.y(), -zb.z())) / (2 * gamma);
  Vec3 v = w; v.x() += 1.0; v /= std::sqrt(2.0 * (w.x() + 1.0));
  const double beta = std::sqrt(al / au);
  const Mat3 j = Vec3(1, -1, -1).asDiagonal();
  s.inverse = beta * (2.0 * v * v.transpose() - j);
  const Vec3 jv = j * v;
  s.f = (2.0 * jv * jv.transpose() - j) / beta;
  s.v = s.f * l;
  return s;
}
Vec3 product(const Vec3& a, const Vec3& b) { return {a.dot(b), a.x() * b.y() + b.x() * a.y(), a.x() * b.z() + b.x() * a.z()}; }
Vec3 divide(const Vec3& v, const Vec3& y) {
  const double x0 = (v.x() * y.x() - v.y() * y.y() - v.z() * y.z()) / det(v);
  return {x0, (y.y() - x0 * v.y()) / v.x(), (y.z() - x0 * v.z()) / v.x()};
}
double longest(const Vec3& x, const Vec3& d) {  // largest step that stays in the cone
  // quadratic (x0+a d0)^2 - |x1+a d1|^2 >= 0
  const double a = det(d) , b = x.x() * d.x() - x.y() * d.y() - x.z() * d.z(), c = det(x);
  double best = 1e30;
  const double disc = b * b - a * c;
  if (a < 0) { best = (-b - std::sqrt(std::max(disc, 0.0))) / a; const double alt = c / (-b + std::sqrt(std::max(disc,0.0))); if (b < 0) best = c / (-b + std::sqrt(std::max(disc, 0.0))); (void)alt; }
  else if (disc > 0 && b < 0) best = c / (-b + std::sqrt(disc));
  if (d.x() < 0) best = std::min(best, -x.x() / d.x());
  return best;
}

class InteriorPoint : public LcpSolver {
 public:
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    const int n = problem.q.size();
    const bool full = getenv("FULL") != nullptr;
    auto en=[](const char* n, double d){return getenv(n)?atof(getenv(n)):d;}; const double T1=en("T1",0.2),T2=en("T2",0.5),TD=en("TD",0.5),TU=en("TU",2), SIG=en("SIG",1), CT=en("CT",0.2);
    MatX w = problem.w->dense();
    std::vector<Mat3> s(n);
    VecX q(3 * n);
    for (int i = 0; i < n; ++i) {
      Mat3 wi = problem.w->diagonal(i);
      Vec3 d(1 / problem.mu[i], 1, 1);
      Mat3 t = d.asDiagonal() * wi * d.asDiagonal();
      double k = 1 / std::sqrt(t.trace() / 3);
      s[i] = (k * d).asDiagonal();
      q.segment<3>(3 * i) = s[i] * problem.q[i];
    }
    double qs = q.lpNorm<Eigen::Infinity>(); q /= qs;
    for (int i = 0; i < n; ++i) for (int j = 0; j < n; ++j) w.block<3,3>(3*i,3*j) = s[i] * w.block<3,3>(3*i,3*j) * s[j];
    VecX l = VecX::Zero(3*n), u = l;
    for (int i = 0; i < n; ++i) l[3*i] = u[3*i] = 1.0;
    std::vector<Vec3> out(n), vel(n); double last = 1, th = 1;
    for (int it = 1; it <= settings.max_iterations; ++it) {
      VecX r = w * l + q - u;
      for (int i = 0; i < n; ++i) r[3*i] += std::hypot(u[3*i+1], u[3*i+2]);
      const double mu = l.dot(u) / n;
      std::vector<Scaling> sc(n);
      MatX m = w;
      for (int i = 0; i < n; ++i) {
        sc[i] = scale_of(l.segment<3>(3*i), u.segment<3>(3*i));
        Mat3 f2 = sc[i].f * sc[i].f;
        if (full) {
          double t = std::hypot(u[3*i+1], u[3*i+2]);
          Mat3 p = Mat3::Identity(); if (t > 0) { p(0,1) = -th*u[3*i+1]/t; p(0,2) = -th*u[3*i+2]/t; }
          f2 = p * f2;
        }
        m.block<3,3>(3*i,3*i) += f2;
      }
      Eigen::LLT<MatX> llt; Eigen::PartialPivLU<MatX> lu;
      if (full) lu.compute(m); else { m = (0.5*(m+m.transpose())).eval(); llt.compute(m); }
      VecX dl, du(3*n);
      auto step = [&](const std::vector<Vec3>& target, double damp) {
        VecX b(3*n);
        for (int i = 0; i < n; ++i) {
          Vec3 t = sc[i].f * divide(sc[i].v, target[i]);
          if (full) { double a = std::hypot(u[3*i+1], u[3*i+2]); if (a > 0) t.x() -= th*(u[3*i+1]*t.y()+u[3*i+2]*t.z())/a; }
          b.segment<3>(3*i) = t - damp * r.segment<3>(3*i);
        }
        if (full) dl = lu.solve(b); else dl = llt.solve(b);
        for (int i = 0; i < n; ++i) du.segment<3>(3*i) = sc[i].f * (divide(sc[i].v, target[i]) - sc[i].f * dl.segment<3>(3*i));
      };
      auto reach = [&] { double a = 1e30; for (int i = 0; i < n; ++i) a = std::min({a, longest(l.segment<3>(3*i), dl.segment<3>(3*i)), longest(u.segment<3>(3*i), du.segment<3>(3*i))}); return a; };
      std::vector<Vec3> target(n);
      for (int i = 0; i < n; ++i) target[i] = -product(sc[i].v, sc[i].v);
      step(target, 1.0);
      double a = std::min(1.0, reach());
      double sigma = std::pow(1 - a, 3);
      const bool care = last < CT;
      if (care) sigma = SIG;
      for (int i = 0; i < n; ++i) {
        target[i] = -product(sc[i].v, sc[i].v) - (care ? 0.0 : 1.0) * product(sc[i].f * dl.segment<3>(3*i), sc[i].inverse * du.segment<3>(3*i));
        target[i].x() += sigma * mu;
      }
      step(target, 1.0);
      a = std::min(1.0, (1 - 1e-2) * reach());
      last = a; if (getenv("V")) printf("th %.2f", th); if (a < T1) th *= TD; else if (a > T2) th = std::min(1.0, th * TU); double cmin = 1e9, cmax = 0;
      for (int i = 0; i < n; ++i) { double e = std::sqrt(std::max(0.0, det(sc[i].v))) ; cmin = std::min(cmin, e*e/mu); cmax = std::max(cmax, sc[i].v.squaredNorm()/mu);}
      if (getenv("V")) printf("   c %.1e %.1e ", cmin, cmax);
      l += a * dl; u += a * du;
      for (int i = 0; i < n; ++i) { out[i] = s[i] * l.segment<3>(3*i) * qs; out[i] = project(out[i], problem.mu[i], problem.law); }
      problem.w->begin(out); velocities(problem, vel);
      const double res = relative_residual(problem, vel, out, settings.measure);
      if (getenv("V")) printf("   %d mu %.2e r %.2e a %.3f sigma %.1e res %.2e lmax %.1e\n", it, mu, r.norm(), a, sigma, res, l.lpNorm<Eigen::Infinity>());
      if (res <= settings.tolerance) { lambda = out; return {it, StopReason::converged}; }
      if (!(a > 1e-12)) { lambda = out; return {it, StopReason::stagnated}; }
    }
    lambda = out;
    return {settings.max_iterations, StopReason::iteration_cap};
  }
};
}
Entry<LcpSolver> interior_point_solver() { return entry<LcpSolver, InteriorPoint>("interior_point", ""); }
}
