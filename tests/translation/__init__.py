"""Tests of the stage that reads printed modules back."""
