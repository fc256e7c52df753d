"""Campaigns: many missions from one description, flown by Snakemake, and the report about them."""
