"""Tests of scripts/figures, with pages and programs made here."""
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / 'scripts/figures'


class Figures(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        self.addCleanup(self.folder.cleanup)

    def compare(self, page, output, *arguments):
        (self.root / 'page.md').write_text(page, encoding='utf-8')
        program = self.root / 'bench_fake'
        program.write_text(f"#!/bin/sh\necho run >>{self.root}/runs\ncat <<'END'\n{output}\nEND\n", encoding='utf-8')
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        done = subprocess.run([sys.executable, str(SCRIPT), '--build', str(self.root), *arguments, str(self.root / 'page.md')],
                              capture_output=True, text=True, check=False)
        return done.returncode, done.stdout

    def test_a_figure_within_its_tolerance_passes_and_one_beyond_it_is_named(self):
        page = '<!-- figures: bench_fake --summary\nbytes: "1,544 bytes" 1%\n-->\nIt takes 1,544\nbytes.\n'
        self.assertEqual(self.compare(page, '{"bytes": 1550}')[0], 0)
        code, text = self.compare(page, '{"bytes": 1600}')
        self.assertEqual(code, 1)
        self.assertIn('"1,544 bytes" is 1600 now', text)

    def test_units_are_converted_and_rounding_of_the_page_is_no_move(self):
        page = '<!-- figures: bench_fake\ntime.us * 0.001: "0.09 ms" 0.1%\n-->\n0.09 ms\n'
        self.assertEqual(self.compare(page, 'text {"time": {"us": 92}}')[0], 0)
        self.assertEqual(self.compare(page, '{"time": {"us": 97}}')[0], 1)

    def test_durations_may_differ_by_a_factor_either_way(self):
        page = '<!-- figures: bench_fake\nus: "10 us" x2\n-->\n10 us\n'
        for now, code in ((6, 0), (19, 0), (4, 1), (21, 1)):
            self.assertEqual(self.compare(page, '{"us": %d}' % now)[0], code, now)

    TABLE = '| range, m | gap | time |\n|---|---|---|\n| 0.1 | 1.005 (2) | 10 |\n| tube | 0.97 | 20 |\n'

    def test_tables_are_compared_row_by_row(self):
        page = '<!-- figures: bench_fake --gaps\ntable 1%\n"time" x3\n-->\n\n' + self.TABLE
        self.assertEqual(self.compare(page, 'more\n' + self.TABLE.replace('20', '50'))[0], 0)
        code, text = self.compare(page, self.TABLE.replace('(2)', '(3)'))
        self.assertEqual(code, 1)
        self.assertIn('row "0.1", column "gap": 1.005 (2) is 1.005 (3) now', text)
        code, text = self.compare(page, self.TABLE.replace('tube', 'ball'))
        self.assertIn('the row "tube" is not printed any more', text)
        code, text = self.compare(page, self.TABLE.replace('gap', 'width'))
        self.assertIn('prints no table with the header', text)

    def test_rows_are_found_by_their_first_numbers(self):
        page = '<!-- figures: bench_fake\nrows 2 2%\n-->\n| slit, m | range | gap | RMS, % |\n|---|---|---|---|\n| 0.4 | 0.1 | 1.005 | 4.0 |\n'
        self.assertEqual(self.compare(page, 'slit range\n0.4 m  0.100  179  1.006  more 4.0')[0], 0)
        self.assertEqual(self.compare(page, '0.4 m  0.100  179  1.1  4.0')[0], 1)
        self.assertEqual(self.compare(page, '0.4 m  0.200  179  1.005  4.0')[0], 1)

    def test_objects_are_compared_member_by_member(self):
        page = '<!-- figures: bench_fake\nobject 1%\n"us" x2\n-->\n\n    {"a": 1.0, "us": 10}\n'
        self.assertEqual(self.compare(page, '{"a": 1.005, "us": 19, "new": 3}')[0], 0)
        self.assertIn('"a" is 1.1 now', self.compare(page, '{"a": 1.1, "us": 10}')[1])
        self.assertEqual(self.compare(page, '{"us": 10}')[0], 1)

    def test_a_command_of_several_groups_runs_once(self):
        page = '<!-- figures: bench_fake\na: "1 a" 1%\n-->\n1 a\n<!-- figures: bench_fake\nb: "2 b" 1%\n-->\n2 b\n'
        code, text = self.compare(page, '{"a": 1, "b": 2}')
        self.assertEqual((code, text), (0, '2 figures compared\n'))
        self.assertEqual((self.root / 'runs').read_text(), 'run\n')

    def test_figures_that_stand_nowhere_are_faults_before_anything_runs(self):
        for page, fault in (
                ('<!-- figures: bench_fake\na: "1 a" 1%\n-->\n2 a\n', 'does not stand below'),
                ('<!-- figures: bench_fake\na: "1 a" 1%\n-->\n## Next\n1 a\n', 'does not stand below'),
                ('<!-- figures: bench_fake\ntable 1%\n-->\nno table\n', 'no table stands below'),
                ('<!-- figures: bench_fake\ntable 1%\n"other" 1%\n-->\n' + self.TABLE, 'no column "other"'),
                ('<!-- figures: bench_fake\na = 1\n-->\n', 'is neither'),
                ('<!-- figures: bench_fake\n-->\n', 'lists no figure')):
            code, text = self.compare(page, '{}', '--check')
            self.assertEqual(code, 1)
            self.assertIn(fault, text)
            self.assertFalse((self.root / 'runs').exists())

    def test_a_program_that_no_build_file_adds_is_a_fault(self):
        code, text = self.compare('<!-- figures: bench_fake\na: "1 a" 1%\n-->\n1 a\n', '{}', '--check')
        self.assertEqual(code, 1)
        self.assertIn('no CMakeLists.txt adds the program "bench_fake"', text)

    def test_missing_and_unusable_values_are_faults(self):
        page = '<!-- figures: bench_fake\na: "1 a" 1%\n-->\n1 a\n'
        for output in ('none', '{"b": 1}', '{"a": "1"}', '{"a": null}'):
            self.assertEqual(self.compare(page, output)[0], 1, output)


if __name__ == '__main__':
    unittest.main()
