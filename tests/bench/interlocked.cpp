// Bodies that hang in one another: how deep they sink, and what it costs.
#include <cstdio>
#include <cstdlib>

#include "tests/support/mechanics/interlocked.hpp"
#include "tests/support/program/bench_arguments.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

void print(const Assembly& what) {
  const AssemblyResult r = run(what, true);
  std::printf("%-7s %4d %8d %7.2f  %8.4f mm %6.2f %%  %8d %11lld %6lld  %9.2g %8.2f m  %8.1f %9.1f (frame %d)\n",
              what.name.c_str(), what.count, what.substeps, what.seconds, 1e3 * r.overlap,
              100.0 * r.overlap / r.thickness, r.contacts, static_cast<long long>(r.unconverged),
              static_cast<long long>(r.unsafe), r.gain / r.fall, r.reach, r.median_ms, r.dearest_ms, r.dearest_frame);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Assembly one;
  BenchArguments arguments(
      "bench_interlocked",
      "Bodies that hang in one another: how deep they sink, by the judge at the end of every sub-step, and\n"
      "what it costs.");
  arguments.word("assembly", one.name, one_of({"chain", "arms", "rollers", "bolt", "arch"}),
                 "chain, arms, rollers, bolt or arch alone; unless given all, by their own counts");
  arguments.number("count", one.count, {1}, "its links, arms or stones");
  arguments.number("seconds", one.seconds, {0.01}, "s, how long it is watched");
  arguments.number("substeps", one.substeps, {1}, "of a frame of 10 ms");
  arguments.read_or_exit(argc, argv);
  std::printf("%-7s %4s %8s %7s  %11s %8s  %8s %11s %6s  %9s %10s  %8s %9s\n", "what", "of", "substeps", "seconds",
              "overlap", "of thick", "a pair", "unconverged", "unsafe", "gain/fall", "moved", "median", "dearest ms");
  if (!one.name.empty()) {
    print(one);
    return 0;
  }
  for (const int substeps : {4, 1})
    for (const Assembly& what :
         {Assembly{"chain", 12, 1, 10.0}, Assembly{"arms", 2, 1, 5.0}, Assembly{"arms", 100, 1, 0.5},
          Assembly{"bolt", 1, 1, 2.0}, Assembly{"arch", 25, 1, 5.0}})
      print({what.name, what.count, substeps, what.seconds});
}
