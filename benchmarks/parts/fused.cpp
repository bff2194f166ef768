// The neo-Hookean internal force as a plain loop over the cells, for benchmarks/parts/bench_kernels.py: what a
// compiler makes of straightforward code.  Threads sum into vectors of their own, which are added afterwards.
#include <cmath>
#include <cstdint>
#include <omp.h>
#include <vector>

template <int A>
static void cell(const double *G, const double *volume, const int32_t *node, const double *u, int points, double lambda,
                 double mu, double *out) {
    double f[A][3] = {};
    for (int q = 0; q < points; ++q, G += 3 * A) {
        double F[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // F[J][i] = dx_i/dX_J
        for (int a = 0; a < A; ++a)
            for (int J = 0; J < 3; ++J)
                for (int i = 0; i < 3; ++i) F[J][i] += G[3 * a + J] * u[3 * node[a] + i];
        double cof[3][3];
        for (int J = 0; J < 3; ++J)
            for (int i = 0; i < 3; ++i) {
                const int K = (J + 1) % 3, L = (J + 2) % 3, k = (i + 1) % 3, l = (i + 2) % 3;
                cof[J][i] = F[K][k] * F[L][l] - F[K][l] * F[L][k];
            }
        const double det = F[0][0] * cof[0][0] + F[0][1] * cof[0][1] + F[0][2] * cof[0][2];
        const double pull = (lambda * std::log(det) - mu) / det;
        for (int J = 0; J < 3; ++J)  // P = mu F + (lambda ln det - mu) F^-T, times the volume
            for (int i = 0; i < 3; ++i) F[J][i] = volume[q] * (mu * F[J][i] + pull * cof[J][i]);
        for (int a = 0; a < A; ++a)
            for (int J = 0; J < 3; ++J)
                for (int i = 0; i < 3; ++i) f[a][i] += G[3 * a + J] * F[J][i];
    }
    for (int a = 0; a < A; ++a)
        for (int i = 0; i < 3; ++i) out[3 * node[a] + i] += f[a][i];
}

template <int A>
static void force(const double *G, const double *volume, const int32_t *nodes, int64_t cells, int points, const double *u,
                  int64_t n, double lambda, double mu, double *out) {
    const int threads = omp_get_max_threads();
    std::vector<double> own(size_t(threads - 1) * 3 * n);
#pragma omp parallel num_threads(threads)
    {
        const int me = omp_get_thread_num();
        double *sum = me ? own.data() + size_t(me - 1) * 3 * n : out;
#pragma omp for schedule(static)
        for (int64_t e = 0; e < cells; ++e)
            cell<A>(G + e * points * 3 * A, volume + e * points, nodes + e * A, u, points, lambda, mu, sum);
#pragma omp for schedule(static)
        for (int64_t k = 0; k < 3 * n; ++k)
            for (int t = 1; t < threads; ++t) out[k] += own[size_t(t - 1) * 3 * n + k];
    }
}

extern "C" int neo_hookean(int a, const double *G, const double *volume, const int32_t *nodes, int64_t cells, int points,
                           const double *u, int64_t n, double lambda, double mu, int threads, double *out) {
    omp_set_num_threads(threads);
    switch (a) {
        case 4: force<4>(G, volume, nodes, cells, points, u, n, lambda, mu, out); return 0;
        case 8: force<8>(G, volume, nodes, cells, points, u, n, lambda, mu, out); return 0;
        case 10: force<10>(G, volume, nodes, cells, points, u, n, lambda, mu, out); return 0;
        case 27: force<27>(G, volume, nodes, cells, points, u, n, lambda, mu, out); return 0;
        default: return 1;
    }
}
