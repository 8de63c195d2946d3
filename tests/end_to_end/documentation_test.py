"""docs/case-file.md is what the program prints."""

import unittest

from harness import SOURCE, TestCase, run


class Documentation(TestCase):
    def test_reference_of_the_case_file(self):
        printed = self.expect_status(0, run("schema", "--markdown")).stdout
        written = (SOURCE / "docs" / "case-file.md").read_text(encoding="utf-8")
        self.assertEqual(written, printed, "write it anew: build/ricochet schema --markdown > docs/case-file.md")


if __name__ == "__main__":
    unittest.main()
